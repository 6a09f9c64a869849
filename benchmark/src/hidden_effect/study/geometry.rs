//! Wrong statements of dimensions of the wheel and the rig.

use super::design::Plan;
use super::wheel_size::WheelSize;

/// A dimension that an experiment states with a relative error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misstatement {
    /// The effect of the catalogue that makes up for the error.
    pub effect: &'static str,
    pub error: f64,
}

impl Misstatement {
    pub const ALL: [Self; 6] = [
        Self::new("slip_radius_error", -0.05),
        Self::new("wheel_radius_error", -0.05),
        Self::new("wheel_width_error", -0.10),
        Self::new("slip_radius_error", 0.05),
        Self::new("wheel_radius_error", 0.05),
        Self::new("wheel_width_error", 0.10),
    ];

    const fn new(effect: &'static str, error: f64) -> Self {
        Self { effect, error }
    }

    /// Returns the plan whose job shows the error: a job that infers the radius makes up for a wrong one by itself.
    pub fn plan(self) -> Plan {
        match self.effect {
            "wheel_radius_error" => Plan::Fixed,
            _ => Plan::Full,
        }
    }

    /// Returns the dimensions that the experiment states. The radius of the rig remains right beside a wrong radius of the wheel.
    pub fn stated(self) -> WheelSize {
        let mut stated = WheelSize::TRUE;
        let dimension = match self.effect {
            "wheel_radius_error" => &mut stated.radius_m,
            "wheel_width_error" => &mut stated.width_m,
            _ => &mut stated.rig_radius_m,
        };
        *dimension *= 1.0 + self.error;
        stated
    }
}
