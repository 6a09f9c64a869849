//! The rim of a run: the quantities that do not depend on the sinkage.

use super::kinematics::RimMotion;
use crate::pressure_distribution::PressureDistribution;
use crate::shear::ShearVelocity;
use crate::wong_reece::PeakedStresses;
use crate::{Condition, Soil, Wheel};

/// The quantities of a run that do not depend on the sinkage.
#[derive(Debug, Clone)]
pub(super) struct Rim {
    pub(super) soil: Soil,
    pub(super) radius: f64,
    pub(super) width: f64,
    pub(super) tan_friction_angle: f64,
    pub(super) motion: RimMotion,
    pub(super) law: PressureDistribution,
    pub(super) shear: ShearVelocity,
    /// x at which the slip velocity changes sign; infinite if it does not.
    pub(super) sign_change: f64,
    /// Half length of the flat of a rim that its load flattens `[m]`; else 0.
    pub(super) flat: f64,
    /// The stresses of Wong & Reece in place of the base's, if requested.
    pub(super) peaked: Option<PeakedStresses>,
}

impl Rim {
    pub(super) fn new(soil: &Soil, wheel: &Wheel, condition: &Condition) -> Self {
        let motion = RimMotion::new(wheel, condition);
        Self {
            soil: *soil,
            radius: wheel.radius_m,
            width: wheel.width_m,
            tan_friction_angle: libm::tan(soil.friction_angle_rad),
            motion,
            law: PressureDistribution::new(soil.gamma_exponent),
            shear: ShearVelocity::new(soil.shear_velocity_m_s),
            sign_change: motion
                .sign_change()
                .map_or(f64::INFINITY, |sin_theta| wheel.radius_m * sin_theta),
            flat: 0.0,
            peaked: None,
        }
    }
}
