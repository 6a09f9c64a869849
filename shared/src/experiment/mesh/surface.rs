//! A surface of triangles, and its bounds.

use serde::{Deserialize, Serialize};

use super::error::MeshError;

/// The maximum number of triangles: a wheel needs no finer surface than the soil's grid.
pub const MAX_TRIANGLES: usize = 200_000;

/// Relative tolerance of the radius: coordinates of STL files have 24 bits.
const ROUNDING: f64 = 1e-6;
/// The maximum distance of the surface from the axle, in units of `radius_m`, which grousers do not exceed.
const LARGEST_REACH: f64 = 1.5;
/// The maximum width of the surface, in units of `width_m`.
const LARGEST_WIDTH: f64 = 1.05;

/// The surface of a rigid wheel at an angle of rotation of 0.
///
/// The axle is the y axis through the origin, z points up, x forward. Vertices are shared by triangles or not; the order
/// of a triangle's vertices does not count, and neither does a gap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WheelMesh {
    /// Vertices: x, y, z `[m]`, finite.
    pub vertices_m: Vec<[f64; 3]>,
    /// Triangles: positions in `vertices_m`. At least one, at most [`MAX_TRIANGLES`].
    pub triangles: Vec<[u32; 3]>,
}

impl WheelMesh {
    /// Checks that the fields are consistent; [`MeshError`] names the vertex or triangle, the value and the bound.
    pub fn check(&self) -> Result<(), MeshError> {
        let (vertices, triangles) = (self.vertices_m.len(), self.triangles.len());
        check_count(triangles)?;
        for (i, v) in self.vertices_m.iter().enumerate() {
            if let Some(x) = v.iter().find(|x| !x.is_finite()) {
                return Err(MeshError::NotFinite {
                    vertex: i + 1,
                    value: *x,
                });
            }
        }
        for (i, t) in self.triangles.iter().enumerate() {
            if let Some(index) = t.iter().find(|&&index| index as usize >= vertices) {
                return Err(MeshError::NoVertex {
                    face: i + 1,
                    vertex: u64::from(*index) + 1,
                    vertices,
                });
            }
        }
        Ok(())
    }

    /// Returns the largest distance of a vertex from the axle `[m]`.
    pub fn reach_m(&self) -> f64 {
        let squares = self.vertices_m.iter().map(|[x, _, z]| x * x + z * z);
        squares.fold(0.0, f64::max).sqrt()
    }

    /// Returns the extent of the surface along the axle `[m]`.
    pub fn width_m(&self) -> f64 {
        let y = || self.vertices_m.iter().map(|v| v[1]);
        y().fold(f64::NEG_INFINITY, f64::max) - y().fold(f64::INFINITY, f64::min)
    }

    /// Checks the surface against the nominal radius and width; [`MeshError::Extent`] if it does not fit.
    pub(in crate::experiment) fn check_against(&self, radius_m: f64, width_m: f64) -> Result<(), MeshError> {
        let extent = |message: String| Err(MeshError::Extent(message));
        let (reach, width) = (self.reach_m(), self.width_m());
        let (max_reach, max_width) = (LARGEST_REACH * radius_m, LARGEST_WIDTH * width_m);
        if reach < radius_m * (1.0 - ROUNDING) {
            return extent(format!(
                "the surface reaches {} m from the axle, but radius_m is {radius_m} m: metres are expected, and the axle is the y axis",
                shown(reach)
            ));
        }
        if reach > max_reach {
            return extent(format!(
                "the surface reaches {} m from the axle, more than {LARGEST_REACH} radius_m = {} m: {}",
                shown(reach),
                shown(max_reach),
                mistake(reach / radius_m)
            ));
        }
        if width > max_width {
            return extent(format!(
                "the surface is {} m wide along y, more than {LARGEST_WIDTH} width_m = {} m: {}",
                shown(width),
                shown(max_width),
                mistake(width / width_m)
            ));
        }
        Ok(())
    }
}

/// Rounds a length to six digits for display.
fn shown(metres: f64) -> f64 {
    format!("{metres:.5e}").parse().unwrap_or(metres)
}

/// Returns the probable mistake behind an extent that is too large by a ratio.
fn mistake(ratio: f64) -> &'static str {
    if ratio > 100.0 {
        "metres are expected, were these millimetres?"
    } else {
        "is the axle the y axis through the origin?"
    }
}

/// Rejects a surface without triangles, or with too many.
pub(super) fn check_count(triangles: usize) -> Result<(), MeshError> {
    match triangles {
        0 => Err(MeshError::Empty),
        1..=MAX_TRIANGLES => Ok(()),
        _ => Err(MeshError::TooMany {
            triangles,
            max: MAX_TRIANGLES,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_table::cases;

    /// Returns a double pyramid of 0.1 m radius about the y axis, 0.04 m wide.
    fn spindle() -> WheelMesh {
        WheelMesh {
            vertices_m: vec![
                [0.0, -0.02, 0.0],
                [0.0, 0.02, 0.0],
                [0.1, 0.0, 0.0],
                [-0.05, 0.0, 0.086_602_540_378_443_9],
                [-0.05, 0.0, -0.086_602_540_378_443_9],
            ],
            triangles: vec![[0, 2, 3], [0, 3, 4], [0, 4, 2], [1, 2, 3], [1, 3, 4], [1, 4, 2]],
        }
    }

    #[test]
    fn reach_and_width_are_measured_from_the_axle() {
        let mesh = spindle();
        assert!((mesh.reach_m() - 0.1).abs() < 1e-15 && (mesh.width_m() - 0.04).abs() < 1e-15);
        assert_eq!(mesh.check(), Ok(()));
        // An STL file states 0.1f32 = 0.100000001…, which may differ from a radius of 0.1000000.
        assert_eq!(mesh.check_against(0.100_000_05, 0.04), Ok(()));
    }

    #[test]
    fn a_surface_that_does_not_fit_its_wheel_names_the_likely_mistake() {
        let mesh = spindle();
        for (size, message) in cases(
            r#"
            0.11 0.04 => reaches 0.1 m from the axle, but radius_m is 0.11 m: metres are expected, and the axle is the y axis
            0.06 0.04 => reaches 0.1 m from the axle, more than 1.5 radius_m = 0.09 m: is the axle the y axis through the origin?
            0.0002 0.04 => reaches 0.1 m from the axle, more than 1.5 radius_m = 0.0003 m: metres are expected, were these millimetres?
            0.1 0.02 => is 0.04 m wide along y, more than 1.05 width_m = 0.021 m: is the axle the y axis through the origin?"#,
        ) {
            let (radius, width) = size.split_once(' ').unwrap();
            let refused = mesh.check_against(radius.parse().unwrap(), width.parse().unwrap());
            assert_eq!(refused.unwrap_err().to_string(), format!("the surface {message}"));
        }
    }

    #[test]
    fn indices_and_numbers_are_checked() {
        type Change = fn(&mut WheelMesh);
        let too_many: Change = |mesh| mesh.triangles = vec![[0, 1, 2]; MAX_TRIANGLES + 1];
        let changes: [(Change, &str); 3] = [
            (
                |mesh| mesh.triangles[2][1] = 5,
                "face 3: vertex 6 is not among the 5 vertices",
            ),
            (
                |mesh| mesh.vertices_m[3][2] = f64::NAN,
                "vertex 4: coordinate NaN m is not finite",
            ),
            (
                too_many,
                "the surface has 200001 triangles, at most 200000 are allowed",
            ),
        ];
        for (change, message) in changes {
            let mut mesh = spindle();
            change(&mut mesh);
            assert_eq!(mesh.check().unwrap_err().to_string(), message);
        }
    }
}
