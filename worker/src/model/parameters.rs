//! The source of each physical quantity: a free parameter, or a fixed value.

use scm::rft::RftSoil;
use scm::spatial::Ground;
use scm::{Soil, WongReece, bekker_moduli};
use shared::model::{ModelError, ModelVariant};

/// The source of one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ParameterSource {
    /// Position in the parameter vector.
    Free(usize),
    Fixed(f64),
}

impl ParameterSource {
    pub(super) fn find(variant: &ModelVariant, name: &str) -> Option<ParameterSource> {
        let free = variant
            .parameters
            .iter()
            .position(|p| p == name)
            .map(ParameterSource::Free);
        free.or_else(|| variant.fixed.get(name).copied().map(ParameterSource::Fixed))
    }

    fn required(variant: &ModelVariant, name: &str) -> Result<ParameterSource, ModelError> {
        ParameterSource::find(variant, name).ok_or_else(|| ModelError::Unset(name.to_owned()))
    }

    pub(super) fn value(self, theta: &[f64]) -> f64 {
        match self {
            ParameterSource::Free(position) => theta[position],
            ParameterSource::Fixed(value) => value,
        }
    }
}

/// The parameters that state the stiffness.
#[derive(Debug)]
enum Stiffness {
    Moduli {
        k_c: ParameterSource,
        k_phi: ParameterSource,
    },
    Reference {
        log10_p_ref: ParameterSource,
        kappa: ParameterSource,
    },
}

/// The sources of the soil parameters.
#[derive(Debug)]
pub(super) struct SoilMap {
    stiffness: Stiffness,
    n: ParameterSource,
    cohesion_pa: ParameterSource,
    friction_angle_deg: ParameterSource,
    shear_velocity_m_s: ParameterSource,
    gamma_exponent: ParameterSource,
}

impl SoilMap {
    pub(super) fn new(variant: &ModelVariant) -> Result<Self, ModelError> {
        let stiffness = match (
            ParameterSource::find(variant, "k_c"),
            ParameterSource::find(variant, "k_phi"),
        ) {
            (Some(k_c), Some(k_phi)) => Stiffness::Moduli { k_c, k_phi },
            _ => Stiffness::Reference {
                log10_p_ref: ParameterSource::required(variant, "log10_p_ref")?,
                kappa: ParameterSource::required(variant, "kappa")?,
            },
        };
        Ok(SoilMap {
            stiffness,
            n: ParameterSource::required(variant, "n")?,
            cohesion_pa: ParameterSource::required(variant, "cohesion_pa")?,
            friction_angle_deg: ParameterSource::required(variant, "friction_angle_deg")?,
            shear_velocity_m_s: ParameterSource::required(variant, "shear_velocity_m_s")?,
            gamma_exponent: ParameterSource::required(variant, "gamma_exponent")?,
        })
    }

    pub(super) fn soil(&self, theta: &[f64]) -> Soil {
        let n = self.n.value(theta);
        let (k_c, k_phi) = match &self.stiffness {
            Stiffness::Moduli { k_c, k_phi } => (k_c.value(theta), k_phi.value(theta)),
            Stiffness::Reference { log10_p_ref, kappa } => {
                bekker_moduli(log10_p_ref.value(theta), kappa.value(theta), n)
            }
        };
        Soil {
            k_c,
            k_phi,
            n,
            cohesion_pa: self.cohesion_pa.value(theta),
            friction_angle_rad: self.friction_angle_deg.value(theta).to_radians(),
            shear_velocity_m_s: self.shear_velocity_m_s.value(theta),
            gamma_exponent: self.gamma_exponent.value(theta),
        }
    }
}

/// The sources of the parameters of soil deformation.
#[derive(Debug)]
pub(super) struct GroundMap {
    elastic_stiffness_pa_m: ParameterSource,
    flow_fraction: ParameterSource,
    bearing_credit: ParameterSource,
}

impl GroundMap {
    pub(super) fn new(variant: &ModelVariant) -> Result<Self, ModelError> {
        Ok(GroundMap {
            elastic_stiffness_pa_m: ParameterSource::required(variant, "elastic_stiffness_pa_m")?,
            flow_fraction: ParameterSource::required(variant, "flow_fraction")?,
            bearing_credit: ParameterSource::required(variant, "bearing_credit")?,
        })
    }

    /// Returns the ground with the condition's angle of repose, or the model's default without one.
    pub(super) fn ground(&self, theta: &[f64], repose_angle_deg: Option<f64>) -> Ground {
        let default = Ground::default();
        Ground {
            elastic_stiffness_pa_m: self.elastic_stiffness_pa_m.value(theta),
            flow_fraction: self.flow_fraction.value(theta),
            bearing_credit: self.bearing_credit.value(theta),
            repose_angle_rad: repose_angle_deg.map_or(default.repose_angle_rad, f64::to_radians),
        }
    }
}

/// The sources of the parameters that Wong & Reece add to a soil.
#[derive(Debug)]
pub(super) struct WongReeceMap {
    c1: ParameterSource,
    c2: ParameterSource,
    shear_modulus_m: ParameterSource,
}

impl WongReeceMap {
    pub(super) fn new(variant: &ModelVariant) -> Result<Self, ModelError> {
        Ok(WongReeceMap {
            c1: ParameterSource::required(variant, "c1")?,
            c2: ParameterSource::required(variant, "c2")?,
            shear_modulus_m: ParameterSource::required(variant, "shear_modulus_m")?,
        })
    }

    pub(super) fn law(&self, theta: &[f64]) -> WongReece {
        WongReece {
            c1: self.c1.value(theta),
            c2: self.c2.value(theta),
            shear_modulus_m: self.shear_modulus_m.value(theta),
        }
    }
}

/// The sources of a soil of resistive force theory.
#[derive(Debug)]
pub(super) struct RftMap {
    xi_n_pa_m: ParameterSource,
    surface_friction: ParameterSource,
}

impl RftMap {
    pub(super) fn new(variant: &ModelVariant) -> Result<Self, ModelError> {
        Ok(RftMap {
            xi_n_pa_m: ParameterSource::required(variant, "xi_n_pa_m")?,
            surface_friction: ParameterSource::required(variant, "surface_friction")?,
        })
    }

    pub(super) fn soil(&self, theta: &[f64]) -> RftSoil {
        RftSoil {
            xi_n_pa_m: self.xi_n_pa_m.value(theta),
            surface_friction: self.surface_friction.value(theta),
        }
    }
}

/// The source of a wheel's radius: the wheel's parameter, the parameter of all wheels, or the experiment.
#[derive(Debug)]
pub(super) struct Radius(Option<ParameterSource>);

impl Radius {
    pub(super) fn new(variant: &ModelVariant, wheel: &str) -> Self {
        let on_wheel = ParameterSource::find(variant, &format!("wheel_radius_m.{wheel}"));
        Radius(on_wheel.or_else(|| ParameterSource::find(variant, "wheel_radius_m")))
    }

    /// Returns the radius `[m]`; `None` = the experiment's.
    pub(super) fn value(&self, theta: &[f64]) -> Option<f64> {
        self.0.map(|source| source.value(theta))
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn moduli_are_converted_alike_everywhere() {
        for (log10_p_ref, kappa, n) in [(4.56, 0.0, 1.1), (3.93, -0.66, 1.295), (5.5, 0.4, 0.8)] {
            let by_names = shared::parameters::bekker_moduli(log10_p_ref, kappa, n);
            assert_eq!(by_names, scm::bekker_moduli(log10_p_ref, kappa, n));
        }
    }
}
