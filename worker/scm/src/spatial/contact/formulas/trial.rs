//! Formulas at a trial height of the hub, a block of nodes at a time.

use formula::block::BLOCK;
use formula::{Hook, Variable};

use super::super::super::pack::{LANES, PACK, Pack, lanes_of, load, max, max_lane, min, splat, store, sum};
use super::super::Contact;
use super::super::laws::Laws;
use super::super::patch::Patch;
use super::super::quad::Quad;
use super::{NodeFormulas, Point, strength};
use crate::Rejection;

/// The minimum depth that formulas see `[m]`, equal to that of the base's powers.
const MIN_DEPTH: f64 = 1e-12;

impl NodeFormulas<'_> {
    /// Computes pressures and strengths, and the vertical force that they exert.
    pub(super) fn sum_forces(&mut self, contact: &mut Contact, laws: &Laws) -> Result<f64, Rejection> {
        let mut force = splat(0.0);
        let packs = contact.across.packs();
        for row in contact.first..contact.end {
            for pack in 0..packs {
                let lanes = contact.masks[row] >> (pack * PACK) & LANES;
                if lanes == 0 {
                    contact.quads[row * packs + pack].pressure = splat(0.0);
                    continue;
                }
                self.see(contact, laws, row, pack, lanes);
                if self.points.len() * PACK == BLOCK {
                    force += self.evaluate(&mut contact.quads, laws)?;
                }
            }
        }
        force += self.evaluate(&mut contact.quads, laws)?;
        Ok(sum(force))
    }

    /// Writes four nodes into the block, with the base's pressure.
    fn see(&mut self, contact: &mut Contact, laws: &Laws, row: usize, pack: usize, lanes: u64) {
        let place = row * contact.across.packs() + pack;
        let at = self.points.len() * PACK;
        self.see_motion(place, at);
        let runs = &contact.patches.runs[contact.patches.by_strip[row - contact.first].clone()];
        let patches = &contact.patches.patches;
        let patch_value = |quantity: fn(&Patch) -> f64| match runs {
            [run] => splat(quantity(&patches[run.patch])),
            _ => runs.iter().fold(splat(0.0), |rest, run| {
                let value = splat(quantity(&patches[run.patch]));
                run.lanes_of(pack).select(value, rest)
            }),
        };
        let quad = &mut contact.quads[place];
        let plastic = patch_value(|patch| patch.stiffness) * quad.shape * quad.depth_power;
        quad.pressure = laws.bounded(plastic, quad.pressed);
        let bears = u64::from(quad.pressure.simd_gt(splat(0.0)).to_bitmask()) & lanes;
        self.points.push(Point { quad: place, bears });
        let uses = self.laws.uses();
        let changes_pressure = self.laws.enter(Hook::Pressure);
        let block = &mut self.laws.block;
        if uses.contains(Variable::Z) {
            let depth = max(quad.depth, splat(MIN_DEPTH));
            store(block.column_mut(Variable::Z), at, depth);
        }
        if uses.contains(Variable::Position) {
            let place = splat(contact.strips[row].middle) + quad.offset;
            let [rear, length] = self.footprint;
            let position = (place - splat(rear)) / splat(length);
            let position = min(max(position, splat(0.0)), splat(1.0));
            store(block.column_mut(Variable::Position), at, position);
        }
        if uses.contains(Variable::KStar) {
            store(
                block.column_mut(Variable::KStar),
                at,
                patch_value(|patch| patch.modulus),
            );
        }
        if uses.contains(Variable::BEff) {
            store(
                block.column_mut(Variable::BEff),
                at,
                patch_value(|patch| patch.b_eff),
            );
        }
        if changes_pressure {
            store(block.column_mut(Variable::P), at, plastic);
        }
    }

    /// Applies the formulas to the nodes of the block, and returns their vertical force, lane by lane.
    fn evaluate(&mut self, quads: &mut [Quad], laws: &Laws) -> Result<Pack, Rejection> {
        let zero = splat(0.0);
        let mut points = core::mem::take(&mut self.points);
        if self.laws.enter(Hook::Pressure) {
            self.apply(Hook::Pressure, &points)?;
            let column = self.laws.block.column(Variable::P);
            for (i, point) in points.iter_mut().enumerate() {
                let quad = &mut quads[point.quad];
                let bounded = laws.bounded(load(column, i * PACK), quad.pressed);
                quad.pressure = lanes_of(point.bears).select(bounded, zero);
                point.bears &= u64::from(quad.pressure.simd_gt(zero).to_bitmask());
            }
        }
        for point in &points {
            self.strengths[point.quad] = strength(laws, &quads[point.quad]);
        }
        if self.laws.enter(Hook::ShearLimit) || self.laws.enter(Hook::Shear) {
            self.change_strengths(quads, &points)?;
        }
        let mut force = zero;
        for point in &points {
            let quad = &quads[point.quad];
            force += quad.area * (quad.pressure + self.strengths[point.quad] * quad.shear_z);
        }
        points.clear();
        self.points = points;
        Ok(force)
    }

    /// Applies the formulas to the strengths of the block's loaded nodes.
    fn change_strengths(&mut self, quads: &[Quad], points: &[Point]) -> Result<(), Rejection> {
        let sees_pressure = self.laws.use_variable(Variable::P);
        let limits = self.laws.enter(Hook::ShearLimit);
        let sees_limit = limits || self.laws.use_variable(Variable::TauMax);
        if sees_pressure {
            let column = self.laws.block.column_mut(Variable::P);
            for (i, point) in points.iter().enumerate() {
                store(column, i * PACK, quads[point.quad].pressure);
            }
        }
        if sees_limit {
            let column = self.laws.block.column_mut(Variable::TauMax);
            for (i, point) in points.iter().enumerate() {
                store(column, i * PACK, self.strengths[point.quad]);
            }
        }
        if limits {
            self.apply(Hook::ShearLimit, points)?;
            let column = self.laws.block.column(Variable::TauMax);
            for (i, point) in points.iter().enumerate() {
                let strength = &mut self.strengths[point.quad];
                *strength = lanes_of(point.bears).select(load(column, i * PACK), *strength);
            }
        }
        if self.laws.enter(Hook::Shear) {
            let column = self.laws.block.column_mut(Variable::Tau);
            for (i, point) in points.iter().enumerate() {
                let stress = self.strengths[point.quad] * self.nodes[point.quad].share;
                store(column, i * PACK, stress);
            }
            self.apply(Hook::Shear, points)?;
            let column = self.laws.block.column(Variable::Tau);
            for (i, point) in points.iter().enumerate() {
                let strength = &mut self.strengths[point.quad];
                let acts = load(column, i * PACK) * self.nodes[point.quad].per_share;
                *strength = lanes_of(point.bears).select(acts, *strength);
            }
        }
        Ok(())
    }
}

impl Contact {
    /// Returns the rear end and length of the footprint, ahead of the hub `[m]`.
    pub(super) fn extent(&self) -> [f64; 2] {
        if self.end == self.first {
            return [0.0, 1.0];
        }
        let packs = self.across.packs();
        let farthest = |row: usize, end: fn(&Quad) -> Pack| {
            let quads = &self.quads[row * packs..(row + 1) * packs];
            max_lane(quads.iter().fold(splat(f64::MIN), |farthest, quad| {
                max(farthest, quad.touching(self.hub).select(end(quad), farthest))
            }))
        };
        let rear = -farthest(self.first, |quad| -quad.rear_end);
        let front = farthest(self.end - 1, |quad| quad.front_end);
        [rear, front - rear]
    }
}
