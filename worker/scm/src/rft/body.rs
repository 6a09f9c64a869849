//! The body of a wheel: its surface as small flat elements.

use core::f64::consts::TAU;

use super::law::dot;
use crate::spatial::SurfaceMesh;

/// Angle that an element of a rim spans `[rad]`: half a degree.
const STEP: f64 = TAU / 720.0;
/// Number of rings of a side wall, which are closer together towards the rim.
const RINGS: usize = 24;
/// Angle that an element of a side wall spans `[rad]`.
const SIDE_STEP: f64 = TAU / 240.0;
/// Number of elements along the height of a grouser.
const ALONG_GROUSER: usize = 6;
/// The maximum side of an element of a mesh, relative to the mesh's reach.
const LONGEST_SIDE: f64 = 0.04;
/// The maximum number of halvings of a triangle's longest side.
const MAX_HALVINGS: u32 = 16;

/// A small flat part of a surface, by its middle; the axle is the y axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element {
    /// Centre of the element `[m]`.
    pub(super) at: [f64; 3],
    /// Normal, out of the body, of length 1.
    pub(super) normal: [f64; 3],
    /// Area of the element `[m²]`.
    pub(super) area: f64,
}

impl Element {
    /// Returns the element after the wheel has turned forwards by an angle of this sine and cosine.
    pub(super) fn turned(&self, sin: f64, cos: f64) -> Self {
        let turn = |v: [f64; 3]| [v[0] * cos + v[2] * sin, v[1], v[2] * cos - v[0] * sin];
        Element {
            at: turn(self.at),
            normal: turn(self.normal),
            area: self.area,
        }
    }
}

/// A cylinder, with straight grousers if there are any.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cylinder {
    pub(super) radius_m: f64,
    pub(super) width_m: f64,
    pub(super) grousers: u32,
    pub(super) grouser_height_m: f64,
    pub(super) grouser_thickness_m: f64,
}

impl Cylinder {
    /// Returns the elements of the surface, with side walls only if the wheel moves sideways, because they otherwise
    /// slide in their own plane.
    pub(super) fn elements(&self, with_sides: bool) -> Vec<Element> {
        let mut elements = Vec::new();
        let (radius, tip) = (self.radius_m, self.radius_m + self.grouser_height_m);
        let pitches = self.grousers.max(1);
        let pitch = TAU / f64::from(pitches);
        let covered = match self.grousers {
            0 => 0.0,
            _ => (self.grouser_thickness_m / radius).min(pitch),
        };
        for number in 0..pitches {
            let begin = f64::from(number) * pitch;
            if covered > 0.0 {
                self.arc(&mut elements, tip, begin, covered * radius / tip);
            }
            self.arc(&mut elements, radius, begin + covered, pitch - covered);
            if self.grousers > 0 {
                self.flank(&mut elements, begin, -1.0);
                self.flank(&mut elements, begin + covered, 1.0);
            }
        }
        if with_sides {
            self.sides(&mut elements);
        }
        elements
    }

    /// Adds elements around the axle from an angle on, counted forwards from straight down.
    fn arc(&self, elements: &mut Vec<Element>, radius: f64, begin: f64, angle: f64) {
        let count = libm::ceil(angle / STEP).max(1.0) as usize;
        let step = angle / count as f64;
        for i in 0..count {
            let angle = begin + (i as f64 + 0.5) * step;
            let normal = [libm::sin(angle), 0.0, -libm::cos(angle)];
            elements.push(Element {
                at: normal.map(|n| radius * n),
                normal,
                area: radius * step * self.width_m,
            });
        }
    }

    /// Adds the flank of a grouser that faces forwards (1) or backwards (−1) around the axle.
    fn flank(&self, elements: &mut Vec<Element>, angle: f64, looks: f64) {
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let height = self.grouser_height_m / ALONG_GROUSER as f64;
        for i in 0..ALONG_GROUSER {
            let radius = self.radius_m + (i as f64 + 0.5) * height;
            elements.push(Element {
                at: [radius * sin, 0.0, -radius * cos],
                normal: [looks * cos, 0.0, looks * sin],
                area: height * self.width_m,
            });
        }
    }

    fn sides(&self, elements: &mut Vec<Element>) {
        // radii R (1 − u²): rings are thin near the soil
        let edge = |ring: usize| {
            let u = ring as f64 / RINGS as f64;
            self.radius_m * (1.0 - u * u)
        };
        let count = libm::round(TAU / SIDE_STEP) as usize;
        for ring in 0..RINGS {
            let (outer, inner) = (edge(ring), edge(ring + 1));
            let radius = 0.5 * (outer + inner);
            for i in 0..count {
                let angle = (i as f64 + 0.5) * SIDE_STEP;
                for side in [-1.0, 1.0] {
                    elements.push(Element {
                        at: [
                            radius * libm::sin(angle),
                            0.5 * side * self.width_m,
                            -radius * libm::cos(angle),
                        ],
                        normal: [0.0, side, 0.0],
                        area: radius * SIDE_STEP * (outer - inner),
                    });
                }
            }
        }
        for number in 0..self.grousers {
            let middle = 0.5 * self.grouser_thickness_m / self.radius_m;
            let angle = f64::from(number) * TAU / f64::from(self.grousers) + middle;
            let height = self.grouser_height_m / ALONG_GROUSER as f64;
            for (i, side) in (0..ALONG_GROUSER).flat_map(|i| [(i, -1.0), (i, 1.0)]) {
                let radius = self.radius_m + (i as f64 + 0.5) * height;
                elements.push(Element {
                    at: [
                        radius * libm::sin(angle),
                        0.5 * side * self.width_m,
                        -radius * libm::cos(angle),
                    ],
                    normal: [0.0, side, 0.0],
                    area: height * self.grouser_thickness_m,
                });
            }
        }
    }
}

/// Returns the elements of a checked mesh: its triangles, halved until none is longer than 4 % of the mesh's reach.
///
/// The order of the vertices determines the outward side; if the enclosed volume is negative, all triangles are reversed.
pub(super) fn mesh_elements(mesh: &SurfaceMesh) -> Vec<Element> {
    let corner = |index: u32| mesh.vertices_m[index as usize];
    let reach = mesh.triangles.iter().flatten();
    let reach = reach.fold(0.0_f64, |far, &i| {
        far.max(libm::hypot(corner(i)[0], corner(i)[2]))
    });
    let mut elements = Vec::new();
    let mut volume = 0.0;
    for triangle in &mesh.triangles {
        let corners = triangle.map(corner);
        volume += dot(corners[0], cross(corners[1], corners[2])) / 6.0;
        halve(&mut elements, corners, LONGEST_SIDE * reach, MAX_HALVINGS);
    }
    if volume < 0.0 {
        for element in &mut elements {
            element.normal = element.normal.map(|n| -n);
        }
    }
    elements
}

fn halve(elements: &mut Vec<Element>, [a, b, c]: [[f64; 3]; 3], longest: f64, left: u32) {
    let (ab, bc, ca) = (length(less(b, a)), length(less(c, b)), length(less(a, c)));
    // the triangle is rotated so that a b is its longest side
    let (a, b, c, side) = if ab >= bc && ab >= ca {
        (a, b, c, ab)
    } else if bc >= ca {
        (b, c, a, bc)
    } else {
        (c, a, b, ca)
    };
    if side > longest && left > 0 {
        let middle = core::array::from_fn(|i| 0.5 * (a[i] + b[i]));
        halve(elements, [a, middle, c], longest, left - 1);
        halve(elements, [middle, b, c], longest, left - 1);
        return;
    }
    let across = cross(less(b, a), less(c, a));
    let twice = length(across);
    if twice > 0.0 {
        elements.push(Element {
            at: core::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0),
            normal: across.map(|component| component / twice),
            area: 0.5 * twice,
        });
    }
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] - b[i])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHEEL: Cylinder = Cylinder {
        radius_m: 0.1,
        width_m: 0.05,
        grousers: 12,
        grouser_height_m: 0.01,
        grouser_thickness_m: 0.002,
    };

    #[test]
    fn a_closed_surface_has_no_direction_and_the_right_volume() {
        let smooth = Cylinder {
            grousers: 0,
            grouser_height_m: 0.0,
            ..WHEEL
        };
        for wheel in [WHEEL, smooth] {
            let elements = wheel.elements(true);
            let total = |quantity: fn(&Element) -> f64| elements.iter().map(quantity).sum::<f64>();
            let axes: [fn(&Element) -> f64; 3] = [
                |e| e.area * e.normal[0],
                |e| e.area * e.normal[1],
                |e| e.area * e.normal[2],
            ];
            assert!(axes.map(total).iter().all(|sum| sum.abs() < 1e-12));
            // the divergence of the position is 3
            let volume = total(|e| e.area * dot(e.at, e.normal)) / 3.0;
            let expected =
                0.05 * core::f64::consts::PI * 0.01 + f64::from(wheel.grousers) * 0.05 * 0.01 * 0.002;
            assert!((volume / expected - 1.0).abs() < 0.01, "{volume} {expected}");
        }
    }

    #[test]
    fn a_mesh_whose_triangles_look_inwards_is_turned_over() {
        // a tetrahedron about the origin
        let vertices_m = vec![
            [0.1, 0.1, 0.1],
            [-0.1, -0.1, 0.1],
            [-0.1, 0.1, -0.1],
            [0.1, -0.1, -0.1],
        ];
        let outwards = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let inwards = outwards.iter().map(|t: &[u32; 3]| [t[0], t[2], t[1]]).collect();
        for triangles in [outwards, inwards] {
            let mesh = SurfaceMesh {
                vertices_m: vertices_m.clone(),
                triangles,
            };
            let elements = mesh_elements(&mesh);
            assert!(elements.iter().all(|e| dot(e.at, e.normal) > 0.0));
            // four faces of side 0.2 √2: √3 · 0.08
            let area: f64 = elements.iter().map(|e| e.area).sum();
            assert!((area - 0.08 * 3.0_f64.sqrt()).abs() < 1e-9, "{area}");
        }
    }
}
