//! Grousers other than straight bars across the whole rim.

use super::grousers::Grousers;
use crate::Wheel;
use crate::rejection::{Rejection, require};

/// The maximum number of rows of grousers.
const MAX_ROWS: u32 = 100;

/// Grousers in rows side by side: staggered, oblique, V-shaped or bent.
///
/// Each row has `grousers.count` at equal distances. Row k of m, counted from the side at smaller y, has its middle at
/// `b ((k + 1/2) / m − 1/2)`, b the wheel's width, and covers [`Tread::width_m`] of it. At y from the wheel's middle plane
/// the middle of a grouser lies further forward along the rim, at the lowest point of the rim, by
///
/// `o(y) = k stagger 2 pi R / count + y tan(angle) + |y| tan(chevron) + bow (2 y / b)²`
///
/// so that with positive `chevron` and `bow` the middle of a grouser enters the soil first, as on a tractor's tyre.
///
/// # Validity
/// A lane of the terrain meets a grouser at the middle of their overlap; if the overlap is narrower than the lane, the grouser is
/// proportionally thinner there, so that the area of all tips is right and does not depend on the end of a row between two lanes.
/// Pressure acts along the wheel's radius, as on straight grousers; the sideways thrust of oblique flanks needs a mesh.
///
/// Checked by `spatial::tread`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tread {
    /// The grousers of one row.
    pub grousers: Grousers,
    /// Number of rows, 1 to 100.
    pub rows: u32,
    /// Shift of a row against the preceding one, relative to the pitch, in [0, 1) `[–]`.
    pub stagger: f64,
    /// Width of a row's grousers `[m]`, > 0; `None`: the whole width of a row, b / m.
    pub width_m: Option<f64>,
    /// Angle of the grousers against the axle, in (−π/2, π/2): positive, the side at greater y is further forward `[rad]`.
    pub angle_rad: f64,
    /// Angle of either half of the grousers against the axle, in (−π/2, π/2): positive, the middle enters the soil first `[rad]`.
    pub chevron_rad: f64,
    /// Distance by which the grousers' ends at the sides of the wheel lie ahead of their middle, on a parabola `[m]`.
    pub bow_m: f64,
}

impl Tread {
    /// Creates straight grousers across the whole width.
    pub fn straight(grousers: Grousers) -> Self {
        Self {
            grousers,
            rows: 1,
            stagger: 0.0,
            width_m: None,
            angle_rad: 0.0,
            chevron_rad: 0.0,
            bow_m: 0.0,
        }
    }

    /// Checks the fields, except those of [`Tread::grousers`]; [`Rejection::InvalidParameter`] names the first outside its bounds.
    pub(super) fn checked(&self, wheel: &Wheel) -> Result<(), Rejection> {
        let rows = f64::from(self.rows);
        let within = (1..=MAX_ROWS).contains(&self.rows);
        require(within, "grouser_rows", rows, "(count)", "between 1 and 100")?;
        let stagger = (0.0..1.0).contains(&self.stagger);
        let unit = "(dimensionless)";
        require(
            stagger,
            "grouser_stagger",
            self.stagger,
            unit,
            "at least 0 and below 1",
        )?;
        if let Some(width) = self.width_m {
            let max_width = wheel.width_m / rows * (1.0 + ROUNDING);
            let bound = "above 0, and at most the wheel's width over the number of rows";
            require(
                width > 0.0 && width <= max_width,
                "grouser_width_m",
                width,
                "m",
                bound,
            )?;
        }
        for (name, angle) in [
            ("grouser_angle_rad", self.angle_rad),
            ("grouser_chevron_rad", self.chevron_rad),
        ] {
            let within = angle.abs() < core::f64::consts::FRAC_PI_2;
            require(within, name, angle, "rad", "above -pi/2 and below pi/2")?;
        }
        require(
            self.bow_m.abs() <= wheel.radius_m,
            "grouser_bow_m",
            self.bow_m,
            "m",
            "at most the wheel's radius, forward or back",
        )
    }

    /// Returns whether every grouser is a straight bar across the whole wheel.
    pub(super) fn is_straight(&self, wheel: &Wheel) -> bool {
        let bends = [self.angle_rad, self.chevron_rad, self.bow_m];
        let min_width = (1.0 - ROUNDING) * wheel.width_m;
        let covers = self
            .width_m
            .is_none_or(|width| width * f64::from(self.rows) >= min_width);
        let aligned = self.rows == 1 || self.stagger.abs() == 0.0;
        let one = covers && aligned && bends.iter().all(|bend| bend.abs() == 0.0);
        one || self.grousers.count == 0
    }

    /// Returns whether left mirrors right.
    pub(super) fn is_symmetric(&self) -> bool {
        let rows = 0..self.rows;
        let alike = |row: u32| {
            let turns = (self.shift(row) - self.shift(self.rows - 1 - row)).abs();
            turns.min(1.0 - turns) < ROUNDING
        };
        self.angle_rad.abs() == 0.0 && rows.into_iter().all(alike)
    }

    /// Returns the shift of a row, relative to the pitch, in [0, 1).
    pub(super) fn shift(&self, row: u32) -> f64 {
        let turns = f64::from(row) * self.stagger;
        turns - libm::floor(turns)
    }

    /// Returns the range that the grousers of a row cover: from y to y on a wheel of a width `[m]`.
    pub(super) fn covers(&self, row: u32, width: f64) -> [f64; 2] {
        let each = width / f64::from(self.rows);
        let middle = (f64::from(row) + 0.5) * each - 0.5 * width;
        let half = 0.5 * self.width_m.unwrap_or(each);
        [middle - half, middle + half]
    }

    /// Returns the distance by which a bend moves a grouser forward at y on a wheel of a width, without its row's shift
    /// `[m]`.
    pub(super) fn bend(&self, y: f64, width: f64) -> f64 {
        let end = 2.0 * y / width;
        y * libm::tan(self.angle_rad) + y.abs() * libm::tan(self.chevron_rad) + self.bow_m * end * end
    }
}

/// Relative difference that rounding can cause.
const ROUNDING: f64 = 1e-9;
