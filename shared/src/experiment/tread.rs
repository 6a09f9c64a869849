//! The arrangement of grousers on a rim, other than straight bars across it.

use serde::{Deserialize, Serialize};

use super::check::{ValueError, positive, possible, require};

/// The maximum number of rows of grousers.
pub(super) const MAX_ROWS: u32 = 100;
/// Relative difference that rounding can cause.
const ROUNDING: f64 = 1e-9;

/// Grousers in rows side by side: staggered, oblique, V-shaped or bent; only `scm` models them.
///
/// Positive angles and bows are forward where the rim is lowest: with positive `chevron_deg` and `bow_m` the middle of a grouser
/// enters the soil before its ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tread {
    /// Number of rows, each with the wheel's `grouser_count`.
    pub rows: u32,
    /// Shift of a row against the one to its right, relative to the distance of its grousers, in [0, 1) `[–]`.
    pub stagger: f64,
    /// Width of a row's grousers `[m]`; `None`: the wheel's width over the number of rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_m: Option<f64>,
    /// Angle of the grousers against the axle; positive: their left end is further forward `[deg]`.
    pub angle_deg: f64,
    /// Angle of either half against the axle `[deg]`.
    pub chevron_deg: f64,
    /// Distance by which the ends of the grousers at the sides of the wheel lie ahead of their middle, on a parabola `[m]`.
    pub bow_m: f64,
}

/// The keys of `[wheel.NAME]` that describe the arrangement of grousers.
#[derive(Debug, Default)]
pub(super) struct RawTread {
    pub(super) rows: Option<u32>,
    pub(super) stagger: Option<f64>,
    pub(super) width_m: Option<f64>,
    pub(super) angle_deg: Option<f64>,
    pub(super) chevron_deg: Option<f64>,
    pub(super) bow_m: Option<f64>,
}

impl RawTread {
    /// Returns the first key that is stated.
    pub(super) fn stated(&self) -> Option<&'static str> {
        let keys = [
            ("grouser_rows", self.rows.is_some()),
            ("grouser_stagger", self.stagger.is_some()),
            ("grouser_width_m", self.width_m.is_some()),
            ("grouser_angle_deg", self.angle_deg.is_some()),
            ("grouser_chevron_deg", self.chevron_deg.is_some()),
            ("grouser_bow_m", self.bow_m.is_some()),
        ];
        keys.into_iter().find_map(|(key, stated)| stated.then_some(key))
    }

    /// Returns the tread of a wheel of a width; `None` if its grousers are straight bars across its whole width.
    pub(super) fn check(&self, wheel_width_m: f64, grousers: u32) -> Result<Option<Tread>, ValueError> {
        let Some(stated) = self.stated() else {
            return Ok(None);
        };
        if grousers == 0 {
            return Err(ValueError::Rule(format!(
                "{stated} says how grousers stand: grouser_count must be at least 1"
            )));
        }
        let tread = Tread {
            rows: self.rows.unwrap_or(1),
            stagger: self.stagger.unwrap_or(0.0),
            width_m: self.width_m,
            angle_deg: self.angle_deg.unwrap_or(0.0),
            chevron_deg: self.chevron_deg.unwrap_or(0.0),
            bow_m: self.bow_m.unwrap_or(0.0),
        };
        tread.check(wheel_width_m)?;
        Ok((!tread.is_straight(wheel_width_m)).then_some(tread))
    }
}

impl Tread {
    fn check(&self, wheel_width_m: f64) -> Result<(), ValueError> {
        let rows = f64::from(self.rows);
        let some = (1..=MAX_ROWS).contains(&self.rows);
        require(some, "grouser_rows", rows, "rows", "between 1 and 100")?;
        let share = (0.0..1.0).contains(&self.stagger);
        let bound = "in [0, 1), a part of the distance from grouser to grouser,";
        require(share, "grouser_stagger", self.stagger, "", bound)?;
        if self.rows == 1 && self.stagger > 0.0 {
            return Err(ValueError::Rule(format!(
                "grouser_stagger {} shifts rows against each other: grouser_rows must be at least 2",
                self.stagger
            )));
        }
        if let Some(width) = self.width_m {
            positive("grouser_width_m", width, "m")?;
            let max_width_m = wheel_width_m / rows;
            let bound = format!("<= width_m / grouser_rows = {max_width_m}");
            require(
                width <= max_width_m * (1.0 + ROUNDING),
                "grouser_width_m",
                width,
                "m",
                &bound,
            )?;
        }
        for (key, value) in [
            ("grouser_angle_deg", self.angle_deg),
            ("grouser_chevron_deg", self.chevron_deg),
            ("grouser_bow_m", self.bow_m),
        ] {
            require(value.is_finite(), key, value, "", "finite")?;
            possible(key, value)?;
        }
        Ok(())
    }

    fn is_straight(&self, wheel_width_m: f64) -> bool {
        let min_width = (1.0 - ROUNDING) * wheel_width_m;
        let covers = self
            .width_m
            .is_none_or(|width| width * f64::from(self.rows) >= min_width);
        let bends = [self.stagger, self.angle_deg, self.chevron_deg, self.bow_m];
        covers && bends.iter().all(|bend| bend.abs() == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(raw: RawTread) -> Result<Option<Tread>, String> {
        raw.check(0.06, 12).map_err(|error| error.to_string())
    }

    #[test]
    fn a_wheel_without_tread_keys_has_straight_bars() {
        assert_eq!(check(RawTread::default()), Ok(None));
        let with = |change: fn(&mut RawTread)| {
            let mut raw = RawTread::default();
            change(&mut raw);
            check(raw)
        };
        let level = with(|t| (t.rows, t.angle_deg) = (Some(1), Some(0.0)));
        let aligned = with(|t| (t.rows, t.stagger, t.width_m) = (Some(3), Some(0.0), Some(0.02)));
        assert_eq!((level, aligned), (Ok(None), Ok(None)));
        let tread = with(|t| (t.rows, t.stagger) = (Some(2), Some(0.5)));
        let tread = tread.unwrap().expect("a tread");
        assert_eq!((tread.rows, tread.stagger, tread.width_m), (2, 0.5, None));
    }

    #[test]
    fn a_tread_that_no_wheel_has_is_refused() {
        type Change = fn(&mut RawTread);
        let changes: [(&str, Change); 7] = [
            ("grouser_rows 0 rows must be between 1 and 100 rows", |t| {
                t.rows = Some(0)
            }),
            (
                "grouser_stagger 0.5 shifts rows against each other: grouser_rows must be at least 2",
                |t| t.stagger = Some(0.5),
            ),
            (
                "grouser_width_m 0.04 m must be <= width_m / grouser_rows = 0.03 m",
                |t| (t.rows, t.width_m) = (Some(2), Some(0.04)),
            ),
            ("grouser_width_m 0 m must be > 0 m", |t| t.width_m = Some(0.0)),
            ("grouser_angle_deg 90 deg must be at most 89 deg", |t| {
                t.angle_deg = Some(90.0)
            }),
            ("grouser_chevron_deg -90 deg must be at least -89 deg", |t| {
                t.chevron_deg = Some(-90.0)
            }),
            (
                "grouser_bow_m 5 m must be at most 1 m: was it typed in mm (0.005 m) or cm (0.05 m)?",
                |t| t.bow_m = Some(5.0),
            ),
        ];
        for (message, change) in changes {
            let mut raw = RawTread::default();
            change(&mut raw);
            assert_eq!(check(raw), Err(message.to_owned()));
        }
        let rows = RawTread {
            rows: Some(2),
            ..RawTread::default()
        };
        let message = "grouser_rows says how grousers stand: grouser_count must be at least 1";
        assert_eq!(rows.check(0.06, 0).unwrap_err().to_string(), message);
    }
}
