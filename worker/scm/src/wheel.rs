//! The rigid wheel.

use crate::rejection::{Rejection, require};

/// A rigid, smooth cylinder on a horizontal axle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheel {
    /// Radius R of the rim that touches the soil `[m]`, > 0.
    pub radius_m: f64,
    /// Width b of the rim `[m]`, > 0.
    pub width_m: f64,
    /// Radius `R_s` with which the rig turns rim speed into slip `[m]`, > 0; R may be inferred, `R_s` is given.
    pub rig_radius_m: f64,
}

impl Wheel {
    /// Checks that the dimensions are positive and finite, and returns the wheel; [`Rejection::InvalidParameter`] names the
    /// first that is not.
    pub fn checked(self) -> Result<Self, Rejection> {
        require(self.radius_m > 0.0, "radius_m", self.radius_m, "m", "above 0")?;
        require(self.width_m > 0.0, "width_m", self.width_m, "m", "above 0")?;
        require(
            self.rig_radius_m > 0.0,
            "rig_radius_m",
            self.rig_radius_m,
            "m",
            "above 0",
        )?;
        Ok(self)
    }
}
