//! Straight grousers across the whole rim.

use crate::Wheel;
use crate::rejection::{Rejection, require};

/// Straight grousers on the rim: rectangles along its whole width, evenly spaced.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Grousers {
    /// Number of grousers; 0: a smooth wheel.
    pub count: u32,
    /// Height above the rim `[m]`, > 0 if there are any.
    pub height_m: f64,
    /// Thickness along the rim `[m]`, > 0 if there are any.
    pub thickness_m: f64,
}

impl Grousers {
    /// Checks that the grousers fit the wheel; [`Rejection::InvalidParameter`] names the first field outside its bounds.
    pub(super) fn checked(&self, wheel: &Wheel) -> Result<(), Rejection> {
        if self.count == 0 {
            return Ok(());
        }
        for (name, value) in [
            ("grouser_height_m", self.height_m),
            ("grouser_thickness_m", self.thickness_m),
        ] {
            require(value > 0.0, name, value, "m", "above 0 where there are grousers")?;
        }
        require(
            self.height_m <= wheel.radius_m,
            "grouser_height_m",
            self.height_m,
            "m",
            "at most the wheel's radius",
        )?;
        let around = f64::from(self.count) * self.thickness_m;
        require(
            around < core::f64::consts::TAU * wheel.radius_m,
            "grouser_thickness_m",
            self.thickness_m,
            "m",
            "so thin that all grousers stand beside each other on the rim",
        )
    }
}
