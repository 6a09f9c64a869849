//! Velocity at which the rim slides over the soil.

use crate::{Condition, Wheel};

/// Steady motion of a rim: it turns at omega and travels at an angle to its heading.
#[derive(Debug, Clone, Copy)]
pub(super) struct RimMotion {
    /// omega R `[m/s]`, with the model's radius R.
    pub(super) rim_speed: f64,
    /// Component of the velocity along the heading, v cos(beta) `[m/s]`.
    pub(super) forward: f64,
    /// Component of the velocity across the heading, v sin(beta) `[m/s]`.
    pub(super) lateral: f64,
}

impl RimMotion {
    pub(super) fn new(wheel: &Wheel, condition: &Condition) -> Self {
        let v = condition.sled_speed_m_s;
        Self {
            rim_speed: condition.rig_rim_speed_m_s() * (wheel.radius_m / wheel.rig_radius_m),
            forward: v * libm::cos(condition.slip_angle_rad),
            lateral: v * libm::sin(condition.slip_angle_rad),
        }
    }

    /// Returns the slip velocity along the rim `[m/s]` at cos(theta); > 0: the rim moves backwards and is pushed
    /// forwards.
    #[inline]
    pub(super) fn tangential(&self, cos_theta: f64) -> f64 {
        self.rim_speed - self.forward * cos_theta
    }

    /// Returns whether every point of the front quarter of the rim pushes backwards or rests.
    pub(super) fn drives_everywhere(&self) -> bool {
        self.tangential(1.0) >= 0.0
    }

    /// Returns sin(theta) in (0, 1] at which the tangential slip velocity changes sign, if it does.
    pub(super) fn sign_change(&self) -> Option<f64> {
        let cos_theta = self.rim_speed / self.forward;
        (0.0..1.0)
            .contains(&cos_theta)
            .then(|| ((1.0 - cos_theta) * (1.0 + cos_theta)).sqrt())
    }
}
