//! The soil's force and torque on the wheel.

use super::super::pack::{PACK, Pack, splat, sum};
use super::super::terrain::Terrain;
use super::super::wheel::motion::Traction;
use super::Contact;
use super::laws::Laws;
use super::patch::Patch;

/// Force and torque of the soil on the wheel about its hub, with the contact that caused them.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Reaction {
    /// Force along the heading, to the left and upwards `[N]`.
    pub(crate) force_x: f64,
    pub(crate) force_y: f64,
    pub(crate) force_z: f64,
    /// Torque that the motor needs `[N m]`.
    pub(crate) torque: f64,
    /// Area of the footprint `[m²]`.
    pub(crate) area: f64,
    pub(crate) nodes: u32,
}

impl Contact {
    /// Returns the soil's force and torque at the last trial height. `strengths` are those of every quad, if formulas
    /// have changed them `[Pa]`.
    pub(crate) fn react(&mut self, terrain: &Terrain, laws: &Laws, strengths: Option<&[Pack]>) -> Reaction {
        let packs = self.across.packs();
        let (cohesion, tan_phi) = (splat(laws.soil.cohesion_pa), splat(laws.tan_friction_angle));
        let mut sums = Sums::default();
        for row in self.first..self.end {
            if self.masks[row] == 0 {
                continue;
            }
            let strip = &self.strips[row];
            let (mut normal, mut shear) = (splat(0.0), splat(0.0));
            for (pack, quad) in self.quads[row * packs..(row + 1) * packs].iter().enumerate() {
                let quad_normal = quad.area * quad.pressure;
                let quad_shear = match strengths {
                    None => quad.area * cohesion + quad_normal * tan_phi,
                    Some(strengths) => quad.area * strengths[row * packs + pack],
                };
                if self.lanes_differ {
                    let tractions = &self.tractions[(row * packs + pack) * PACK..][..PACK];
                    sums.add(
                        strip.ahead,
                        &Along::from_lanes(tractions),
                        quad_normal,
                        quad_shear,
                    );
                } else {
                    normal += quad_normal;
                    shear += quad_shear;
                }
            }
            if !self.lanes_differ {
                sums.add(
                    strip.ahead,
                    &Along::from_strip(&self.tractions[row]),
                    normal,
                    shear,
                );
            }
        }
        let Sums {
            force_x,
            force_y,
            force_z,
            torque,
        } = sums;
        let double = if terrain.mirrored { 2.0 } else { 1.0 };
        let mut reaction = Reaction {
            force_x: double * sum(force_x),
            force_y: if terrain.mirrored { 0.0 } else { sum(force_y) },
            force_z: double * sum(force_z),
            torque: double * sum(torque),
            nodes: self.masks[self.first..self.end]
                .iter()
                .map(|m| m.count_ones())
                .sum(),
            ..Reaction::default()
        };
        if terrain.mirrored {
            reaction.nodes *= 2;
        }
        reaction.area = self.area(terrain);
        reaction
    }

    /// Returns the effective width of the hull, or mean of the patches weighted by area `[m]`.
    pub(crate) fn effective_width(&mut self, terrain: &Terrain, laws: &Laws) -> f64 {
        self.find_effective_widths(terrain, laws);
        self.mean_of(|patch| patch.b_eff)
    }

    /// Returns the mean modulus k* of the patches, weighted by area `[N/m^(n+2)]`.
    pub(crate) fn modulus(&self) -> f64 {
        self.mean_of(|patch| patch.modulus)
    }

    fn mean_of(&self, quantity: impl Fn(&Patch) -> f64) -> f64 {
        let (mut area, mut weighted) = (0.0, 0.0);
        for patch in &self.patches.patches {
            area += patch.area;
            weighted += patch.area * quantity(patch);
        }
        if area > 0.0 { weighted / area } else { 0.0 }
    }

    /// Returns the area of the footprint `[m²]`.
    pub(crate) fn area(&self, terrain: &Terrain) -> f64 {
        let double = if terrain.mirrored { 2.0 } else { 1.0 };
        double * self.patches.patches.iter().map(|p| p.area).sum::<f64>()
    }
}

/// Forces and torque, lane by lane.
#[derive(Default)]
struct Sums {
    force_x: Pack,
    force_y: Pack,
    force_z: Pack,
    torque: Pack,
}

impl Sums {
    /// Adds normal and shear forces that act in the same directions.
    fn add(&mut self, ahead: f64, along: &Along, normal: Pack, shear: Pack) {
        let x = normal * along.pressure_x + shear * along.shear_x;
        let z = normal + shear * along.shear_z;
        self.force_x += x;
        self.force_y += normal * along.pressure_y + shear * along.shear_y;
        self.force_z += z;
        self.torque += along.rise * x + splat(ahead) * z;
    }
}

/// Tractions of four lanes.
struct Along {
    rise: Pack,
    pressure_x: Pack,
    pressure_y: Pack,
    shear_x: Pack,
    shear_y: Pack,
    shear_z: Pack,
}

impl Along {
    fn from_strip(t: &Traction) -> Self {
        Self {
            rise: splat(t.rise),
            pressure_x: splat(t.pressure_x),
            pressure_y: splat(t.pressure_y),
            shear_x: splat(t.shear_x),
            shear_y: splat(t.shear_y),
            shear_z: splat(t.shear_z),
        }
    }

    fn from_lanes(t: &[Traction]) -> Self {
        let pack = |quantity| Traction::from_lanes(t, quantity);
        Self {
            rise: pack(|t| t.rise),
            pressure_x: pack(|t| t.pressure_x),
            pressure_y: pack(|t| t.pressure_y),
            shear_x: pack(|t| t.shear_x),
            shear_y: pack(|t| t.shear_y),
            shear_z: pack(|t| t.shear_z),
        }
    }
}
