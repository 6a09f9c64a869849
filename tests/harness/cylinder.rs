//! The surface of a wheel as a mesh file: a cylinder of flat facets, with or without straight grousers.

use std::f64::consts::TAU;
use std::fmt::Write;

/// Corners of a triangle `[m]`.
pub type Triangle = [[f64; 3]; 3];

/// A wheel about the y axis.
#[derive(Debug, Clone, Copy)]
pub struct Cylinder {
    /// Facets around the rim.
    pub facets: u32,
    /// Radius of the corners of the facets `[m]`.
    pub radius_m: f64,
    /// Width along the axle `[m]`.
    pub width_m: f64,
    /// Number of grousers, evenly around the rim; the first one points along x.
    pub grousers: u32,
    /// Height of a grouser above the rim `[m]`.
    pub grouser_height_m: f64,
    /// Thickness of a grouser `[m]`.
    pub grouser_thickness_m: f64,
}

impl Cylinder {
    /// Returns a smooth cylinder.
    pub fn smooth(facets: u32, radius_m: f64, width_m: f64) -> Cylinder {
        Cylinder {
            facets,
            radius_m,
            width_m,
            grousers: 0,
            grouser_height_m: 0.0,
            grouser_thickness_m: 0.0,
        }
    }

    /// Returns the outline around the axle, as x and z, in order of the angle.
    fn outline(&self) -> Vec<[f64; 2]> {
        let half = (0.5 * self.grouser_thickness_m / self.radius_m).asin();
        let grousers: Vec<f64> = (0..self.grousers)
            .map(|i| TAU * f64::from(i) / f64::from(self.grousers))
            .collect();
        let clear = |angle: f64| {
            grousers.iter().all(|g| {
                let off = (angle - g).rem_euclid(TAU);
                off.min(TAU - off) > half
            })
        };
        let at = |angle: f64, radius: f64| (angle, [radius * angle.cos(), radius * angle.sin()]);
        let mut points: Vec<(f64, [f64; 2])> = (0..self.facets)
            .map(|i| TAU * f64::from(i) / f64::from(self.facets))
            .filter(|angle| clear(*angle))
            .map(|angle| at(angle, self.radius_m))
            .collect();
        let tip = self.radius_m * half.cos() + self.grouser_height_m;
        let tip_half = (0.5 * self.grouser_thickness_m).atan2(tip);
        let tip_radius = tip.hypot(0.5 * self.grouser_thickness_m);
        for g in grousers {
            points.extend([at(g - half, self.radius_m), at(g + half, self.radius_m)]);
            points.extend([at(g - tip_half, tip_radius), at(g + tip_half, tip_radius)]);
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.into_iter().map(|(_, point)| point).collect()
    }

    /// Returns the triangles: rim, then both sides as fans about the axle.
    pub fn triangles(&self) -> Vec<Triangle> {
        let outline = self.outline();
        let y = 0.5 * self.width_m;
        let mut triangles = Vec::new();
        for (i, &[x, z]) in outline.iter().enumerate() {
            let [x2, z2] = outline[(i + 1) % outline.len()];
            triangles.push([[x, -y, z], [x2, -y, z2], [x2, y, z2]]);
            triangles.push([[x, -y, z], [x2, y, z2], [x, y, z]]);
            triangles.push([[0.0, -y, 0.0], [x2, -y, z2], [x, -y, z]]);
            triangles.push([[0.0, y, 0.0], [x, y, z], [x2, y, z2]]);
        }
        triangles
    }

    /// Returns the surface as ASCII STL, every coordinate times `scale`.
    pub fn ascii_stl(&self, scale: f64) -> String {
        let mut text = String::from("solid wheel of a test\n");
        for triangle in self.triangles() {
            text.push_str("  facet normal 0 0 0\n    outer loop\n");
            for [x, y, z] in triangle.map(|v| v.map(|x| (x * scale) as f32)) {
                writeln!(text, "      vertex {x} {y} {z}").expect("a string takes all text");
            }
            text.push_str("    endloop\n  endfacet\n");
        }
        text + "endsolid wheel of a test\n"
    }

    /// Returns the surface as binary STL.
    pub fn binary_stl(&self) -> Vec<u8> {
        let triangles = self.triangles();
        let mut bytes = b"solid is how this header begins, too".to_vec();
        bytes.resize(80, 0);
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|x| (*x as f32).to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    /// Returns the surface as OBJ, no vertex shared.
    pub fn obj(&self) -> String {
        let mut text = String::from("o wheel\n");
        for (i, triangle) in self.triangles().into_iter().enumerate() {
            for [x, y, z] in triangle {
                writeln!(text, "v {x} {y} {z}").expect("a string takes all text");
            }
            let first = 3 * i + 1;
            writeln!(text, "f {first} {} {}", first + 1, first + 2).expect("a string takes all text");
        }
        text
    }
}
