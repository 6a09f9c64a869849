//! The contact of wheel and terrain: the nodes in contact and their pressure.
//!
//! # Layout
//! - `quad`: the state of four neighbouring nodes.
//! - `patch`: connected nodes in contact.
//! - `distance`: ends of the contact between nodes, areas, distances to the border.
//! - `contour`: contour lengths of the patches; `hull`: the rectangle that they span; `span`: gaps and runs of lanes.
//! - `laws`: pressure and its distribution; `power`: z^n for many nodes.
//! - `reaction`: force and torque on the wheel.
//! - `formulas`: pressure and shear stress after the effects.

mod contour;
mod distance;
pub(super) mod formulas;
mod hull;
pub(super) mod laws;
mod patch;
mod power;
mod quad;
pub(super) mod reaction;
mod span;
#[cfg(test)]
mod tests;

use laws::Laws;
use patch::{Patches, Run};
use quad::{Quad, Under};
use span::Span;

use super::pack::{PACK, Pack, splat, sum};
use super::settings::Footprint;
use super::terrain::Terrain;
use super::wheel::across::Across;
use super::wheel::envelope::{Envelope, NOWHERE, Strip};
use super::wheel::motion::{Motion, Traction};
use crate::footprint::effective_width;

/// The maximum number of lanes under a wheel: one bit of a mask for each.
pub(crate) const MAX_LANES: usize = 64;

/// The wheel on the terrain at one place, for trials at several heights.
///
/// The first and the last strip are guards that never touch, so that every strip in contact has neighbours.
#[derive(Debug, Clone, Default)]
pub(crate) struct Contact {
    pub(crate) across: Across,
    pub(crate) strips: Vec<Strip>,
    /// Quads of all strips, each with all its packs of lanes.
    pub(crate) quads: Vec<Quad>,
    /// Hub height at which a strip begins to touch `[m]`.
    highest: Vec<f64>,
    /// Forces per unit of pressure and strength, by strip, or by strip and lane.
    pub(crate) tractions: Vec<Traction>,
    pub(crate) lanes_differ: bool,
    /// Strips `first..end` hold all nodes in contact. Bit j of a strip's mask means that lane j is in contact.
    pub(crate) first: usize,
    pub(crate) end: usize,
    pub(crate) masks: Vec<u64>,
    pub(crate) patches: Patches,
    /// The last trial height `[m]`.
    pub(crate) hub: f64,
    /// Distances of one strip's lanes to the ends along the travel, and to the border `[m]`.
    pub(crate) along: Vec<[f64; PACK]>,
    pub(crate) distance: Vec<[f64; PACK]>,
    /// Squares of the distances of one strip, padded on both sides.
    pub(crate) squares: Vec<f64>,
    /// Spans for the hull, by strip in contact and pack.
    spans: Vec<Span>,
    /// The effective width that applies to nodes.
    pub(crate) footprint: Footprint,
    pub(crate) trials: u64,
    pub(crate) node_trials: u64,
}

impl Contact {
    /// Creates a contact whose nodes have the effective width of the hull, or of their patches.
    pub(crate) fn new(footprint: Footprint) -> Self {
        Self {
            footprint,
            ..Self::default()
        }
    }

    /// Computes everything that does not depend on the height of the hub, for a wheel on the terrain.
    ///
    /// With `vertical` the pressure acts upwards whatever the slope of the wheel's surface.
    pub(crate) fn prepare(
        &mut self,
        terrain: &Terrain,
        envelope: &Envelope,
        laws: &Laws,
        motion: &Motion,
        vertical: bool,
    ) {
        self.strips.clone_from(&envelope.strips);
        let rows = self.strips.len();
        let packs = self.across.packs();
        self.quads.resize(rows * packs, Quad::blank());
        self.squares.resize(3 * packs * PACK, f64::MAX);
        self.along.resize(packs, [0.0; PACK]);
        self.distance.resize(packs, [0.0; PACK]);
        self.masks.resize(rows, 0);
        self.lanes_differ = !envelope.facets.is_empty();
        self.find_tractions(envelope, laws, motion, vertical);
        self.highest.clear();
        let credit = splat(laws.bearing_credit);
        for (row, (quads, strip)) in self.quads.chunks_exact_mut(packs).zip(&self.strips).enumerate() {
            let start = strip.column * terrain.lanes + self.across.first_lane;
            let under = Under {
                surface: terrain.surface[start..start + packs * PACK].as_chunks().0,
                loose: terrain.loose[start..start + packs * PACK].as_chunks().0,
                bias: &self.across.bias,
                credit,
            };
            let guard = row == 0 || row + 1 == rows;
            let highest = if guard || !self.lanes_differ {
                let rise = splat(if guard { NOWHERE } else { strip.rise });
                let (slope, shear_z) = (splat(strip.slope), splat(self.tractions[row].shear_z));
                under.meet(quads, |_| (rise, slope, shear_z))
            } else {
                under.meet(quads, |pack| {
                    let facet = envelope.facets[pack * rows + row];
                    let lanes = &self.tractions[(row * packs + pack) * PACK..][..PACK];
                    let shear = Traction::from_lanes(lanes, |t| t.shear_z);
                    (facet.rise, facet.slope_x, shear)
                })
            };
            self.highest.push(highest);
        }
        if terrain.is_dug() {
            self.lower_references(terrain);
        }
    }

    fn find_tractions(&mut self, envelope: &Envelope, laws: &Laws, motion: &Motion, vertical: bool) {
        let tilts = if vertical { 0.0 } else { 1.0 };
        let law = &laws.shear_velocity;
        self.tractions.clear();
        if !self.lanes_differ {
            let strips = self.strips.iter();
            self.tractions
                .extend(strips.map(|s| motion.traction(law, s.ahead, s.rise, [tilts * s.slope, 0.0])));
            return;
        }
        let rows = self.strips.len();
        for (row, strip) in self.strips.iter().enumerate() {
            for facet in envelope.facets[row..].iter().step_by(rows) {
                let (rise, x, y) = (
                    facet.rise.to_array(),
                    facet.slope_x.to_array(),
                    facet.slope_y.to_array(),
                );
                self.tractions.extend(
                    (0..PACK)
                        .map(|i| motion.traction(law, strip.ahead, rise[i], [tilts * x[i], tilts * y[i]])),
                );
            }
        }
    }

    /// Returns the vertical force of the soil on the wheel with its hub at a height `[N]`.
    pub(crate) fn press(&mut self, terrain: &Terrain, laws: &Laws, hub: f64) -> f64 {
        let cohesive = laws.soil.k_c.abs() > 0.0;
        self.find_patches(terrain, laws, hub, cohesive);
        let half = self.sum_pressures(laws);
        if terrain.mirrored { 2.0 * half } else { half }
    }

    /// Finds the nodes in contact with the hub at a height, and their patches; `contours`: with their lengths.
    #[inline]
    fn find_patches(&mut self, terrain: &Terrain, laws: &Laws, hub: f64, contours: bool) {
        self.touch(hub);
        self.measure(terrain, laws, hub);
        if contours {
            self.find_effective_widths(terrain, laws);
        }
        let cohesive = laws.soil.k_c.abs() > 0.0;
        for patch in &mut self.patches.patches {
            let k_star = if cohesive {
                laws.soil.k_phi + laws.soil.k_c / patch.b_eff
            } else {
                laws.soil.k_phi
            };
            let shape = sum(patch.shapes);
            let carries = k_star > 0.0 && shape > 0.0;
            patch.modulus = k_star;
            patch.stiffness = if carries { k_star * patch.area / shape } else { 0.0 };
        }
        self.trials += 1;
    }

    /// Computes the effective widths of the patches at the last trial height, from their areas.
    pub(crate) fn find_effective_widths(&mut self, terrain: &Terrain, laws: &Laws) {
        match self.footprint {
            Footprint::Hull => {
                let b_eff = self.hull_width(terrain, laws);
                for patch in &mut self.patches.patches {
                    patch.b_eff = b_eff;
                }
            }
            Footprint::Patches => {
                self.add_contours(terrain);
                for patch in &mut self.patches.patches {
                    patch.b_eff = effective_width(patch.area, patch.contour);
                }
            }
        }
    }

    /// Finds the nodes in contact, their patches, and the rear ends of the contact.
    fn touch(&mut self, hub: f64) {
        let rows = self.strips.len();
        self.hub = hub;
        (self.first, self.end) = (rows, 0);
        self.masks.fill(0);
        for row in 1..rows.saturating_sub(1) {
            if self.highest[row] <= hub {
                continue;
            }
            self.find_rear_ends(row, hub);
            self.first = self.first.min(row);
            self.end = row + 1;
            self.node_trials += u64::from(self.masks[row].count_ones());
        }
        self.end = self.end.max(self.first);
        self.patches.label(self.first, &self.masks[self.first..self.end]);
    }

    /// Computes pressures, and the vertical force of pressure and shear stress.
    fn sum_pressures(&mut self, laws: &Laws) -> f64 {
        let packs = self.across.packs();
        let (cohesion, tan_phi) = (splat(laws.soil.cohesion_pa), splat(laws.tan_friction_angle));
        let mut force = splat(0.0);
        let quads = self.quads[self.first * packs..self.end * packs].chunks_exact_mut(packs);
        for (quads, runs) in quads.zip(&self.patches.by_strip) {
            let runs = &self.patches.runs[runs.clone()];
            if runs.is_empty() {
                continue;
            }
            let stiffness = |run: &Run| splat(self.patches.patches[run.patch].stiffness);
            let same = if let [run] = runs {
                Some(stiffness(run))
            } else {
                None
            };
            for (pack, quad) in quads.iter_mut().enumerate() {
                let stiffness = same.unwrap_or_else(|| {
                    runs.iter().fold(splat(0.0), |rest, run| {
                        run.lanes_of(pack).select(stiffness(run), rest)
                    })
                });
                let p = laws.bounded(stiffness * quad.shape * quad.depth_power, quad.pressed);
                quad.pressure = p;
                force += quad.area * (p + (cohesion + p * tan_phi) * quad.shear_z);
            }
        }
        sum(force)
    }

    /// Returns the height of the hub above the wheel's surface over four lanes `[m]`, of the quad at `place` in strip
    /// `row`.
    pub(crate) fn rise(&self, place: usize, row: usize) -> Pack {
        if self.lanes_differ {
            Traction::from_lanes(&self.tractions[place * PACK..][..PACK], |t| t.rise)
        } else {
            splat(self.strips[row].rise)
        }
    }

    /// Returns the slip velocity of four lanes `[m/s]`, of the quad at `place` in strip `row`.
    pub(crate) fn slip_speed(&self, place: usize, row: usize) -> Pack {
        if self.lanes_differ {
            Traction::from_lanes(&self.tractions[place * PACK..][..PACK], |t| t.slip_speed)
        } else {
            splat(self.tractions[row].slip_speed)
        }
    }

    /// Returns a quad by strip and lane.
    #[inline]
    pub(crate) fn quad(&self, row: usize, lane: usize) -> &Quad {
        &self.quads[row * self.across.packs() + lane / PACK]
    }
}
