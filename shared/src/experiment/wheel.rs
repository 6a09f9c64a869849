//! A wheel as `[wheel.NAME]` describes it.

use serde::{Deserialize, Serialize};

use super::mesh::{self, SurfaceMesh};
use super::settings::positive;

/// A rigid wheel. `quasi_static` models its smooth rim alone: grousers enter through a radius of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Wheel {
    /// Radius of the rim `[m]`; beside a mesh, the radius that slip and sinkage refer to.
    pub radius_m: f64,
    /// Width of the rim `[m]`; beside a mesh, the width of the lane.
    pub width_m: f64,
    /// Number of straight grousers.
    pub grouser_count: u32,
    /// Height of a grouser above the rim `[m]`.
    pub grouser_height_m: f64,
    /// Thickness of a grouser along the rim `[m]`.
    pub grouser_thickness_m: f64,
    /// Radius with which the rig turns slip into rim speed `[m]`.
    pub rig_radius_m: f64,
    /// The surface, where it is given instead of rim and grousers. Not written where there is none, so that a variant
    /// without a mesh has the text, and the hash, that it had before there were meshes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<SurfaceMesh>,
}

impl Wheel {
    /// Whether grousers are declared, be it only by a height.
    pub fn has_grousers(&self) -> bool {
        self.grouser_count > 0 || self.grouser_height_m > 0.0
    }
}

/// The keys of `[wheel.NAME]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawWheel {
    mesh: Option<String>,
    radius_m: f64,
    width_m: f64,
    grouser_count: Option<u32>,
    grouser_height_m: Option<f64>,
    grouser_thickness_m: Option<f64>,
    rig_radius_m: Option<f64>,
}

impl RawWheel {
    /// The wheel without its mesh, and the name of the mesh's file.
    pub(super) fn check(self) -> Result<(Wheel, Option<String>), String> {
        let wheel = Wheel {
            radius_m: self.radius_m,
            width_m: self.width_m,
            grouser_count: self.grouser_count.unwrap_or(0),
            grouser_height_m: self.grouser_height_m.unwrap_or(0.0),
            grouser_thickness_m: self.grouser_thickness_m.unwrap_or(0.0),
            rig_radius_m: self.rig_radius_m.unwrap_or(self.radius_m),
            mesh: None,
        };
        if let Some(file) = &self.mesh {
            mesh::check_name(file)?;
            for (key, stated) in [
                ("grouser_count", self.grouser_count.is_some()),
                ("grouser_height_m", self.grouser_height_m.is_some()),
                ("grouser_thickness_m", self.grouser_thickness_m.is_some()),
            ] {
                if stated {
                    return Err(format!(
                        "{key} stands beside mesh = \"{file}\": grousers are part of the surface"
                    ));
                }
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
            if !(value.is_finite() && value >= 0.0) {
                return Err(format!("{key} {value} m must be >= 0 m"));
            }
        }
        Ok((wheel, self.mesh))
    }
}
