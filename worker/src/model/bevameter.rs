//! Plate and ring readings from the parameters of a variant.

use scm::bevameter::{Plate, plate, ring};
use scm::shear::ShearDisplacement;
use scm::{Rejection, Soil};
use shared::model::{ModelError, ModelVariant};
use shared::parameters::RING_TRANSFER;

use super::parameters::{ParameterSource, SoilMap};

/// The only effect that acts on a ring.
const SHEAR_DISPLACEMENT: &str = "janosi_hanamoto";
/// The parameter of that effect for all wheels, because a ring is not a wheel.
const SHEAR_MODULUS: &str = "janosi_hanamoto.shear_modulus_m";

/// Returns the effects of a variant that do not act on plates and rings.
pub fn without_action(variant: &ModelVariant) -> impl Iterator<Item = &str> {
    let felt = ParameterSource::find(variant, SHEAR_MODULUS).map(|_| SHEAR_DISPLACEMENT);
    let names = variant.effects.iter().map(|effect| effect.name.as_str());
    names.filter(move |&name| Some(name) != felt)
}

/// The soil and the shear-displacement law of a variant, with their parameters resolved.
#[derive(Debug)]
pub struct CompiledBevameter {
    soil: SoilMap,
    modulus: Option<ParameterSource>,
    ln_transfer: Option<ParameterSource>,
}

/// The readings of a bevameter at one parameter vector.
#[derive(Debug)]
pub struct Readings {
    soil: Soil,
    /// The soil under a ring, whose tan(phi) may differ.
    under_ring: Soil,
    law: ShearDisplacement,
}

impl CompiledBevameter {
    /// Resolves the names of a variant, without its wheels and conditions; [`ModelError::Unset`] names a missing parameter.
    pub fn new(variant: &ModelVariant) -> Result<Self, ModelError> {
        Ok(CompiledBevameter {
            soil: SoilMap::new(variant)?,
            modulus: ParameterSource::find(variant, SHEAR_MODULUS),
            ln_transfer: ParameterSource::find(variant, RING_TRANSFER),
        })
    }

    /// Returns the readings at one parameter vector.
    pub fn at(&self, theta: &[f64]) -> Readings {
        let soil = self.soil.soil(theta);
        let friction_angle_rad = match self.ln_transfer {
            None => soil.friction_angle_rad,
            Some(source) => {
                let factor = libm::exp(source.value(theta));
                libm::atan(factor * libm::tan(soil.friction_angle_rad))
            }
        };
        Readings {
            under_ring: Soil {
                friction_angle_rad,
                ..soil
            },
            soil,
            law: ShearDisplacement::new(self.modulus.map_or(0.0, |k| k.value(theta))),
        }
    }
}

impl Readings {
    /// Returns the pressure `[Pa]` under a round plate of this radius `[m]` at this sinkage `[m]`; a [`Rejection`] if
    /// the soil cannot carry such a plate, or a number is outside its bounds.
    pub fn pressure_pa(&self, plate_radius_m: f64, sinkage_m: f64) -> Result<f64, Rejection> {
        let radius_m = plate_radius_m;
        plate::pressure(&self.soil, &Plate::Circle { radius_m }, sinkage_m)
    }

    /// Returns the shear stress `[Pa]` under a ring at this normal stress `[Pa]` after this displacement `[m]`; a
    /// [`Rejection`] if a number is outside its bounds.
    pub fn shear_stress_pa(&self, normal_stress_pa: f64, displacement_m: f64) -> Result<f64, Rejection> {
        ring::shear_stress(&self.under_ring, &self.law, normal_stress_pa, displacement_m)
    }
}
