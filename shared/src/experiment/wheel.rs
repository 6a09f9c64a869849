//! A wheel as `[wheel.NAME]` describes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::check::{ValueError, not_negative, positive};
use super::mesh::{self, WheelMesh};
use super::tread::{MAX_ROWS, RawTread, Tread};

/// Returns the speed of the rim `[m/s]` with the rig's radius: `v / (1 - s)` for s ≥ 0 and `v (1 + s)` for s < 0, v the
/// sled speed `[m/s]`; 0 for a locked wheel.
pub fn rim_speed_m_s(slip: f64, sled_speed_m_s: f64) -> f64 {
    if slip < 0.0 {
        sled_speed_m_s * (1.0 + slip)
    } else {
        sled_speed_m_s / (1.0 - slip)
    }
}

/// A rigid wheel. `quasi_static` models its smooth rim alone unless its grousers roll; their tips then have a larger radius.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WheelGeometry {
    /// Radius of the rim `[m]`; with a mesh, the radius that slip and sinkage refer to.
    pub radius_m: f64,
    /// Width of the rim `[m]`; with a mesh, the width of the lane.
    pub width_m: f64,
    /// Number of grousers; with a tread, in each row.
    pub grouser_count: u32,
    /// Height of a grouser above the rim `[m]`.
    pub grouser_height_m: f64,
    /// Thickness of a grouser along the rim `[m]`.
    pub grouser_thickness_m: f64,
    /// Radius with which the rig turns slip into rim speed `[m]`.
    pub rig_radius_m: f64,
    /// The surface, in place of rim and grousers. It is omitted from the text if absent, so that a variant without a mesh
    /// keeps the text and hash of versions without meshes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<WheelMesh>,
    /// The arrangement of the grousers, if they are not straight bars across the rim; else omitted from the text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tread: Option<Tread>,
}

impl WheelGeometry {
    /// Returns whether grousers are declared, by their count or their height.
    pub fn has_grousers(&self) -> bool {
        self.grouser_count > 0 || self.grouser_height_m > 0.0
    }

    /// Rejects a sinkage `[m]` beyond the wheel's diameter, which indicates a mistake of units.
    pub(super) fn check_sinkage(&self, sinkage_m: f64) -> Result<(), ValueError> {
        let diameter = 2.0 * self.radius_m;
        if sinkage_m.abs() > diameter {
            return Err(ValueError::Rule(format!(
                "sinkage_m {sinkage_m} m is more than the wheel's diameter {diameter} m: metres are expected, were these millimetres or centimetres?"
            )));
        }
        Ok(())
    }

    /// Returns the time from one grouser to the next `[s]`, with the rim speed computed by the rig: `2 pi R_s / (N
    /// omega R_s)` with `omega R_s = v / (1 - s)` for s ≥ 0 and `v (1 + s)` for s < 0, v the sled speed `[m/s]`.
    ///
    /// `None` without a count of grousers, and for a wheel that does not turn. A surface mesh has no count.
    pub fn grouser_period_s(&self, slip: f64, sled_speed_m_s: f64) -> Option<f64> {
        let rim_speed_m_s = rim_speed_m_s(slip, sled_speed_m_s);
        let turns = self.grouser_count > 0 && rim_speed_m_s > 0.0;
        turns.then(|| {
            std::f64::consts::TAU * self.rig_radius_m / (f64::from(self.grouser_count) * rim_speed_m_s)
        })
    }
}

/// A rigid wheel: the keys of `[wheel.NAME]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RawWheel {
    /// Surface in place of rim and grousers, STL or OBJ; for `scm`.
    mesh: Option<String>,
    /// Radius of the rim `[m]`; with a mesh, the radius that slip and sinkage refer to.
    #[schemars(extend("exclusiveMinimum" = 0))]
    radius_m: f64,
    /// Width of the rim `[m]`; with a mesh, the width of the lane.
    #[schemars(extend("exclusiveMinimum" = 0))]
    width_m: f64,
    /// Number of grousers, in each row.
    #[schemars(range(max = u32::MAX), extend("default" = 0))]
    grouser_count: Option<u32>,
    /// Height of a grouser above the rim `[m]`.
    #[schemars(range(min = 0), extend("default" = 0.0))]
    grouser_height_m: Option<f64>,
    /// Thickness of a grouser along the rim `[m]`.
    #[schemars(range(min = 0), extend("default" = 0.0))]
    grouser_thickness_m: Option<f64>,
    /// Number of rows of grousers side by side, each with `grouser_count`; for `scm`.
    #[schemars(range(min = 1, max = MAX_ROWS), extend("default" = 1))]
    grouser_rows: Option<u32>,
    /// Shift of a row against the one to its right, relative to the distance of its grousers.
    #[schemars(range(min = 0), extend("exclusiveMaximum" = 1, "default" = 0.0))]
    grouser_stagger: Option<f64>,
    /// Width of the grousers of a row `[m]`; `width_m / grouser_rows` if it is not stated.
    #[schemars(extend("exclusiveMinimum" = 0))]
    grouser_width_m: Option<f64>,
    /// Angle of the grousers against the axle `[deg]`; positive: the left end is further forward.
    #[schemars(range(min = -89, max = 89), extend("default" = 0.0))]
    grouser_angle_deg: Option<f64>,
    /// Angle of either half of a V `[deg]`; positive: its middle enters the soil first.
    #[schemars(range(min = -89, max = 89), extend("default" = 0.0))]
    grouser_chevron_deg: Option<f64>,
    /// Distance by which the grousers' ends lie ahead of their middle, on a parabola `[m]`.
    #[schemars(range(min = -1, max = 1), extend("default" = 0.0))]
    grouser_bow_m: Option<f64>,
    /// Radius with which the rig converts slip to rim speed `[m]`; `radius_m` if it is not stated.
    #[schemars(extend("exclusiveMinimum" = 0))]
    rig_radius_m: Option<f64>,
}

impl RawWheel {
    /// Returns the wheel without its mesh, and the name of the mesh's file.
    pub(super) fn check(self) -> Result<(WheelGeometry, Option<String>), ValueError> {
        let mut wheel = WheelGeometry {
            radius_m: self.radius_m,
            width_m: self.width_m,
            grouser_count: self.grouser_count.unwrap_or(0),
            grouser_height_m: self.grouser_height_m.unwrap_or(0.0),
            grouser_thickness_m: self.grouser_thickness_m.unwrap_or(0.0),
            rig_radius_m: self.rig_radius_m.unwrap_or(self.radius_m),
            mesh: None,
            tread: None,
        };
        let tread = RawTread {
            rows: self.grouser_rows,
            stagger: self.grouser_stagger,
            width_m: self.grouser_width_m,
            angle_deg: self.grouser_angle_deg,
            chevron_deg: self.grouser_chevron_deg,
            bow_m: self.grouser_bow_m,
        };
        if let Some(file) = &self.mesh {
            mesh::check_name(file)?;
            let keys = [
                ("grouser_count", self.grouser_count.is_some()),
                ("grouser_height_m", self.grouser_height_m.is_some()),
                ("grouser_thickness_m", self.grouser_thickness_m.is_some()),
            ];
            let stated = keys.into_iter().find_map(|(key, stated)| stated.then_some(key));
            if let Some(key) = stated.or(tread.stated()) {
                return Err(ValueError::Rule(format!(
                    "{key} has no place beside mesh = \"{file}\": grousers are part of the surface"
                )));
            }
        }
        for (key, value) in [
            ("radius_m", wheel.radius_m),
            ("width_m", wheel.width_m),
            ("rig_radius_m", wheel.rig_radius_m),
        ] {
            positive(key, value, "m")?;
        }
        for (key, value) in [
            ("grouser_height_m", wheel.grouser_height_m),
            ("grouser_thickness_m", wheel.grouser_thickness_m),
        ] {
            not_negative(key, value, "m")?;
        }
        wheel.tread = tread.check(wheel.width_m, wheel.grouser_count)?;
        Ok((wheel, self.mesh))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grouser_follows_the_other_after_a_twelfth_of_a_turn() {
        let mut wheel = WheelGeometry {
            radius_m: 0.13,
            width_m: 0.1,
            grouser_count: 12,
            grouser_height_m: 0.0,
            grouser_thickness_m: 0.0,
            rig_radius_m: 0.125,
            mesh: None,
            tread: None,
        };
        // 8 mm/s at slip 0.2 and 12.5 mm/s at slip -0.2 both give 10 mm/s of the rim: 2 pi 0.125 m / 12 / 0.01 m/s
        for (slip, speed) in [(0.2, 0.008), (-0.2, 0.0125)] {
            let period = wheel.grouser_period_s(slip, speed).unwrap();
            assert!((period - 6.544_984_694_978_736).abs() < 1e-12, "{period}");
        }
        assert_eq!(wheel.grouser_period_s(-1.0, 0.01), None);
        wheel.grouser_count = 0;
        assert_eq!(wheel.grouser_period_s(0.2, 0.01), None);
    }

    #[test]
    fn a_field_that_no_wheel_has_is_refused_on_the_wire_and_named_with_its_line_in_a_file() {
        let wheel = r#"{"radius_m":0.1,"width_m":0.05,"grouser_count":0,"grouser_height_m":0.0,"grouser_thickness_m":0.0,"rig_radius_m":0.1"#;
        assert!(serde_json::from_str::<WheelGeometry>(&format!("{wheel}}}")).is_ok());
        let stray = serde_json::from_str::<WheelGeometry>(&format!("{wheel},\"tread_m\":0.1}}"));
        assert!(stray.unwrap_err().to_string().contains("tread_m"));
        let files = crate::file::FileSet {
            toml: "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\ngrouser_hight_m = 0.005\n[soil.sand]\n[noise]\n".into(),
            files: [("runs.csv".into(), String::new())].into(),
        };
        let error = crate::experiment::Experiment::parse("experiment.toml", &files).unwrap_err();
        for words in ["experiment.toml line 5", "grouser_hight_m", "grouser_height_m"] {
            assert!(error.to_string().contains(words), "{words} in {error}");
        }
    }
}
