//! Wheels made of triangles, from profiles drawn along the axle.

use scm::spatial::SurfaceMesh;

/// A point of a profile: x and z at y = 0.
type Point = [f64; 2];

/// A surface under construction.
#[derive(Default)]
pub(crate) struct Surface(pub(crate) SurfaceMesh);

impl Surface {
    /// Draws a line of the profile along places `ys` of the axle, scaled by `scale` at each; a triangle at y has its mirror
    /// image at −y if the places have.
    pub(crate) fn draw(&mut self, from: Point, to: Point, ys: &[f64], scale: impl Fn(f64) -> f64) {
        let mesh = &mut self.0;
        for sides in ys.windows(2) {
            let first = mesh.vertices_m.len() as u32;
            for &y in sides {
                let f = scale(y);
                mesh.vertices_m.push([from[0] * f, y, from[1] * f]);
                mesh.vertices_m.push([to[0] * f, y, to[1] * f]);
            }
            let [a, b, c, d] = [first, first + 1, first + 2, first + 3];
            let both = if sides[0] + sides[1] < 0.0 {
                [[a, b, c], [b, d, c]]
            } else {
                [[c, d, a], [d, b, a]]
            };
            mesh.triangles.extend(both);
        }
    }

    /// Returns a rim of flat facets, its corners on the circle.
    pub(crate) fn rim(
        mut self,
        radius: f64,
        facets: u32,
        ys: &[f64],
        scale: impl Fn(f64) -> f64 + Copy,
    ) -> Self {
        let corner = |i: u32| on_circle(radius, std::f64::consts::TAU * f64::from(i) / f64::from(facets));
        for i in 0..facets {
            self.draw(corner(i), corner((i + 1) % facets), ys, scale);
        }
        self
    }

    /// Boxes on the rim: two flanks and a tip each, the first at the bottom.
    pub(crate) fn grousers(
        mut self,
        radius: f64,
        count: u32,
        height: f64,
        thickness: f64,
        ys: &[f64],
    ) -> Self {
        for i in 0..count {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
            for side in profile(radius, height, thickness, angle).windows(2) {
                self.draw(side[0], side[1], ys, |_| 1.0);
            }
        }
        self
    }

    /// Boxes on the rim that lie further forward by `ahead(y)` along it, with straight lines from place to place.
    pub(crate) fn bent_grousers(
        mut self,
        radius: f64,
        count: u32,
        height: f64,
        thickness: f64,
        ys: &[f64],
        ahead: impl Fn(f64) -> f64,
    ) -> Self {
        for i in 0..count {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
            let at = |y: f64| profile(radius, height, thickness, angle + ahead(y) / radius);
            for sides in ys.windows(2) {
                let first = self.0.vertices_m.len() as u32;
                let corners = |y: f64| at(y).map(|[x, z]| [x, y, z]);
                self.0
                    .vertices_m
                    .extend(corners(sides[0]).into_iter().chain(corners(sides[1])));
                for k in first..first + 3 {
                    self.0
                        .triangles
                        .extend([[k, k + 1, k + 4], [k + 1, k + 5, k + 4]]);
                }
            }
        }
        self
    }
}

/// Foot, tip, tip and foot of a box on the rim at an angle, from rear to front.
fn profile(radius: f64, height: f64, thickness: f64, angle: f64) -> [Point; 4] {
    let (sin, cos) = angle.sin_cos();
    let at = |r: f64, aside: f64| [r * sin + aside * cos, -(r * cos - aside * sin)];
    let (foot, tip, half) = (0.98 * radius, radius + height, 0.5 * thickness);
    [at(foot, -half), at(tip, -half), at(tip, half), at(foot, half)]
}

/// Returns the point of a circle at an angle from straight down, positive forward.
fn on_circle(radius: f64, angle: f64) -> Point {
    [radius * angle.sin(), -radius * angle.cos()]
}

/// Places from −b/2 to b/2 at equal distances.
pub(crate) fn across(width: f64, parts: u32) -> Vec<f64> {
    (0..=parts)
        .map(|i| width * (f64::from(i) / f64::from(parts) - 0.5))
        .collect()
}
