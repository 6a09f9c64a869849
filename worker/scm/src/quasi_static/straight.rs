//! Straight grousers of the quasi-static model.

use crate::rejection::{Rejection, require};

/// Straight grousers on a rim: rectangles along its whole width, evenly spaced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightGrousers {
    /// Number of grousers; 0: a smooth rim.
    pub count: u32,
    /// Height above the rim `[m]`, ≥ 0 and at most the radius; 0: a smooth rim.
    pub height_m: f64,
    /// Thickness along the rim `[m]`, > 0 if there are any.
    pub thickness_m: f64,
}

impl StraightGrousers {
    /// Returns whether the rim has no grousers.
    pub(super) fn are_absent(&self) -> bool {
        self.count == 0 || self.height_m.abs() <= 0.0
    }

    /// Checks that the grousers fit on a rim of a radius `[m]`, and returns them; [`Rejection::InvalidParameter`] names the
    /// first field outside its bounds.
    pub(super) fn checked(self, radius_m: f64) -> Result<Self, Rejection> {
        let (height, thickness) = (self.height_m, self.thickness_m);
        let bound = "above 0 and at most the wheel's radius";
        let fits = height > 0.0 && height <= radius_m;
        require(fits, "grouser_height_m", height, "m", bound)?;
        let fits = thickness > 0.0 && f64::from(self.count) * thickness < core::f64::consts::TAU * radius_m;
        let bound = "above 0 and so thin that all grousers stand beside each other on the rim";
        require(fits, "grouser_thickness_m", thickness, "m", bound)?;
        Ok(self)
    }
}
