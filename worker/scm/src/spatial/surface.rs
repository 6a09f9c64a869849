//! A rigid wheel given by the triangles of its surface.

use crate::rejection::{Rejection, require};

/// The surface of a rigid wheel at an angle of rotation of 0.
///
/// The axle is the y axis through the origin, z points up, x forward; a wheel that rolls forward turns its top forward. Only
/// the lowest point above each place of the soil counts, h(x, y) = min z, so that neither the order of a triangle's vertices
/// nor hidden parts matter.
///
/// # Validity
/// The surface is sampled in the middle of each of the terrain's lanes, and along travel at most 1 mm apart, exactly on the
/// triangles' planes. Across the wheel a part counts by whole lanes: its width is accurate to a lane's spacing. Along travel
/// a part narrower than the distance of samples is hit with a frequency proportional to its width. The lanes are spread
/// evenly over twice the largest |y|. A rim of N flat facets sinks deeper than the cylinder by about `(π/N)² R/3`, the mean
/// height of its chords above the arc.
///
/// Checked by `spatial::mesh`: within 0.002 W of the analytic rim's drawbar pull from 45 facets on, within 0.4 % of its
/// sinkage from 180 on; with grousers and radial normals within 0.003 W and 1.2 %.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurfaceMesh {
    /// Vertices: x, y, z `[m]`, finite.
    pub vertices_m: Vec<[f64; 3]>,
    /// Triangles: positions in `vertices_m`; at least one.
    pub triangles: Vec<[u32; 3]>,
}

/// The directions in which a point of a mesh is pressed and sheared.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Normals {
    /// The normal of the triangle, with the flanks of grousers.
    ///
    /// Per horizontal area a triangle of slopes (dh/dx, dh/dy) is pressed with p (−dh/dx, −dh/dy, 1). A triangle steeper
    /// than 10 : 1 (84°) keeps its place but presses with a slope of 10, because a sample on it would represent more flank
    /// than there is. A vertical triangle has no horizontal area and does not press, although its edge forms the step.
    ///
    /// The flanks of 12 straight grousers add 0.07 W to the drawbar pull and 0.08 W R to the torque of the analytic wheel
    /// on a grid of 4 mm, 0.12 W and 0.12 W R on one of 1 mm: a height field resolves them only slowly.
    #[default]
    Surface,
    /// The direction from the point to the axle, as on the analytic rim: for comparison with it.
    Radial,
}

impl SurfaceMesh {
    /// Checks that the surface can be that of a wheel.
    ///
    /// # Errors
    /// [`Rejection::InvalidParameter`] with `triangles` for none, or for a position beyond the vertices (the value is
    /// that position); with `vertices_m` for a coordinate that is not finite, or if all lies on the axle or in the
    /// middle plane. Checked by `spatial::mesh::invalid_meshes_are_rejected`.
    pub fn checked(&self) -> Result<(), Rejection> {
        let count = self.triangles.len();
        require(count > 0, "triangles", count as f64, "(count)", "at least 1")?;
        for &coordinate in self.vertices_m.iter().flatten() {
            require(true, "vertices_m", coordinate, "m", "finite")?;
        }
        let (mut reach, mut aside) = (0.0_f64, 0.0_f64);
        for &index in self.triangles.iter().flatten() {
            let vertex = self.vertices_m.get(index as usize);
            require(
                vertex.is_some(),
                "triangles",
                f64::from(index),
                "(position)",
                "below the number of vertices",
            )?;
            let [x, y, z] = vertex.copied().unwrap_or_default();
            (reach, aside) = (reach.max(libm::hypot(x, z)), aside.max(y.abs()));
        }
        require(
            reach > 0.0,
            "vertices_m",
            reach,
            "m",
            "above 0 at the largest distance from the axle",
        )?;
        let bound = "above 0 at the largest distance from the middle plane";
        require(aside > 0.0, "vertices_m", aside, "m", bound)
    }
}
