//! The constitutive laws, prepared for many nodes.

use super::super::pack::{Pack, max, min, splat};
use super::power::Power;
use crate::Soil;
use crate::pressure_distribution::PressureDistribution;
use crate::shear::ShearVelocity;

/// The laws of one soil.
#[derive(Debug, Clone)]
pub(crate) struct Laws {
    pub(crate) soil: Soil,
    pub(crate) tan_friction_angle: f64,
    pub(crate) shear_velocity: ShearVelocity,
    /// Stiffness of unloading and reloading `[Pa/m]`.
    pub(crate) elastic_stiffness: f64,
    /// Share of the loose soil that carries load like undisturbed soil `[–]`.
    pub(crate) bearing_credit: f64,
    sinkage_power: Power,
    distribution: PressureDistribution,
    distance_power: Option<Power>,
}

impl Laws {
    pub(crate) fn new(soil: &Soil, elastic_stiffness: f64, bearing_credit: f64) -> Self {
        let distribution = PressureDistribution::new(soil.gamma_exponent);
        Self {
            soil: *soil,
            tan_friction_angle: libm::tan(soil.friction_angle_rad),
            shear_velocity: ShearVelocity::new(soil.shear_velocity_m_s),
            elastic_stiffness,
            bearing_credit,
            sinkage_power: Power::new(soil.n),
            distribution,
            distance_power: match distribution {
                PressureDistribution::Power(m) => Some(Power::new(m)),
                _ => None,
            },
        }
    }

    /// Returns the shape g of the pressure distribution at a distance to the border, up to a constant factor.
    #[inline]
    pub(crate) fn shape(&self, distance: Pack) -> Pack {
        match (self.distribution, &self.distance_power) {
            (PressureDistribution::Root, _) => distance.sqrt(),
            (PressureDistribution::Linear, _) => distance,
            // the distance is in millimetres, so that high powers do not vanish
            (_, Some(power)) => power.raise(distance * splat(1e3)),
            (_, None) => splat(1.0),
        }
    }

    /// Returns z^n of Bekker's plastic pressure `gamma k* z^n`, z below the reference.
    #[inline]
    pub(crate) fn depth_power(&self, depth: Pack) -> Pack {
        self.sinkage_power.raise(depth)
    }

    /// Limits a plastic pressure to the elastic line from the present surface, without suction.
    #[inline]
    pub(crate) fn bounded(&self, plastic: Pack, penetration: Pack) -> Pack {
        let elastic = splat(self.elastic_stiffness) * penetration;
        max(min(plastic, elastic), splat(0.0))
    }
}
