//! The conditions of one run of the single-wheel rig.

use crate::rejection::{Rejection, require};

/// The conditions that the rig prescribes during one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// Slip `(omega R_s − v) / max(omega R_s, v)` `[–]`, in [−1, 1); `R_s` is the rig's radius. Negative: skid;
    /// −1: locked wheel.
    pub slip: f64,
    /// Vertical load W on the wheel `[N]`, > 0.
    pub wheel_load_n: f64,
    /// Speed v of the sled along its travel `[m/s]`, > 0.
    pub sled_speed_m_s: f64,
    /// Angle beta from the wheel's heading to the travel `[rad]`, in [−π/2, π/2].
    pub slip_angle_rad: f64,
    /// Number of the measured pass over the same track, ≥ 1. A model without memory of the track, such as the base
    /// [`quasi_static`](crate::quasi_static) one, gives the same answer for every pass.
    pub pass: u32,
}

impl Condition {
    /// Checks that every field is within its bounds, and returns the condition; [`Rejection::InvalidParameter`] names the
    /// first field that is not.
    pub fn checked(self) -> Result<Self, Rejection> {
        let beta = self.slip_angle_rad;
        let slip = self.slip;
        require(
            (-1.0..1.0).contains(&slip),
            "slip",
            slip,
            "(dimensionless)",
            "in [-1, 1)",
        )?;
        require(
            self.wheel_load_n > 0.0,
            "wheel_load_n",
            self.wheel_load_n,
            "N",
            "above 0",
        )?;
        require(
            self.sled_speed_m_s > 0.0,
            "sled_speed_m_s",
            self.sled_speed_m_s,
            "m/s",
            "above 0",
        )?;
        require(
            beta.abs() <= core::f64::consts::FRAC_PI_2,
            "slip_angle_rad",
            beta,
            "rad",
            "between -pi/2 and pi/2",
        )?;
        require(
            self.pass >= 1,
            "pass",
            f64::from(self.pass),
            "(count)",
            "at least 1",
        )?;
        Ok(self)
    }

    /// Returns the rim speed as computed by the rig, `omega R_s = v / (1 − s)` for s ≥ 0 and `v (1 + s)` for s < 0
    /// `[m/s]`.
    pub fn rig_rim_speed_m_s(&self) -> f64 {
        if self.slip < 0.0 {
            self.sled_speed_m_s * (1.0 + self.slip)
        } else {
            self.sled_speed_m_s / (1.0 - self.slip)
        }
    }
}
