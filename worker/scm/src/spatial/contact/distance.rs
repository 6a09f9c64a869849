//! The geometry of a footprint: ends of the contact between nodes, areas, distances to the border.

use super::super::pack::{LANES, PACK, Pack, lanes_of, max, max_lane, min, min_lane, splat, sum};
use super::super::terrain::Terrain;
use super::Contact;
use super::laws::Laws;
use super::patch::{Patches, lanes_in_runs};

/// Distance along the travel of a node without contact; only the minimum of the distances matters.
const FAR: f64 = 1e100;

impl Contact {
    /// Computes areas, depths and shapes of the nodes in contact, and their sums over each patch.
    pub(crate) fn measure(&mut self, terrain: &Terrain, laws: &Laws, hub: f64) {
        for row in (self.first..self.end).rev() {
            if self.masks[row] != 0 {
                let spread = self.find_front_ends(row, hub);
                self.correct_distances(terrain, row, spread);
                self.find_shapes(laws, row);
            }
        }
        for patch in &mut self.patches.patches {
            patch.area = sum(patch.areas);
        }
    }

    /// Finds the nodes of a strip in contact, and the rear ends of their contact.
    pub(crate) fn find_rear_ends(&mut self, row: usize, hub: f64) {
        let packs = self.across.packs();
        let (strip, previous) = (&self.strips[row], &self.strips[row - 1]);
        let (behind, current) = self.quads[(row - 1) * packs..(row + 1) * packs].split_at_mut(packs);
        let mut mask = 0;
        for (pack, (quad, behind)) in current.iter_mut().zip(&*behind).enumerate() {
            mask |= u64::from(quad.touching(hub).to_bitmask()) << (pack * PACK);
            quad.rear_end = behind.rear_end;
        }
        self.masks[row] = mask;
        let mut begins = mask & !self.masks[row - 1];
        if begins == 0 {
            return;
        }
        let (middle, gap) = (splat(strip.middle), splat(strip.middle - previous.middle));
        let half = splat(strip.middle - strip.rear);
        for (quad, behind) in current.iter_mut().zip(&*behind) {
            if begins & LANES != 0 {
                let ends = lanes_of(begins);
                (quad.left, quad.tilt) = (half, splat(0.0));
                if strip.smooth && previous.smooth {
                    let tilt = (quad.surface - behind.surface) / gap;
                    quad.left = ends.select((quad.surface - splat(hub)) / tilt, half);
                    quad.tilt = ends.select(tilt, quad.tilt);
                }
                quad.rear_end = ends.select(middle - quad.left, quad.rear_end);
            }
            begins >>= PACK;
        }
    }

    /// Finds the front ends of a strip's contact from the strip ahead, and the quantities that depend on both ends.
    ///
    /// Returns the difference of the squares of the strip's maximum and minimum distance along the travel.
    fn find_front_ends(&mut self, row: usize, hub: f64) -> f64 {
        let packs = self.across.packs();
        let (zero, far) = (splat(0.0), splat(FAR));
        let (strip, next) = (&self.strips[row], &self.strips[row + 1]);
        let mask = self.masks[row];
        let (mut begins, mut ceases) = (mask & !self.masks[row - 1], mask & !self.masks[row + 1]);
        let (middle, half) = (splat(strip.middle), splat(strip.middle - strip.rear));
        let (whole, gap) = (half + half, splat(next.middle - strip.middle));
        let (mut nearest, mut farthest) = (far, zero);
        let (current, ahead) = self.quads[row * packs..(row + 2) * packs].split_at_mut(packs);
        let across = self.across.width.iter().zip(&self.across.from_side);
        let distances = self.along.iter_mut().zip(&mut self.distance);
        for (((quad, ahead), (along, distance)), (&width, &from_side)) in
            current.iter_mut().zip(&*ahead).zip(distances).zip(across)
        {
            let touching = quad.touching(hub);
            quad.front_end = ahead.front_end;
            quad.offset = zero;
            quad.pressed = quad.surface - splat(hub);
            quad.depth = quad.reference - splat(hub);
            let mut covered = whole;
            if (begins | ceases) & LANES != 0 {
                let (left, mut right, mut tilt) = if begins & LANES != 0 {
                    (quad.left, half, -quad.tilt)
                } else {
                    (half, half, zero)
                };
                let ends = lanes_of(ceases);
                if strip.smooth && next.smooth {
                    let falls = (quad.surface - ahead.surface) / gap;
                    right = ends.select(quad.pressed / falls, half);
                    tilt = ends.select(falls, tilt);
                }
                quad.front_end = ends.select(middle + right, quad.front_end);
                // The pressure is evaluated in the middle of the covered part.
                quad.offset = (right - left) * splat(0.5);
                quad.pressed -= tilt * quad.offset;
                quad.depth -= quad.slope * quad.offset;
                covered = left + right;
            }
            (begins, ceases) = (begins >> PACK, ceases >> PACK);
            quad.area = touching.select(covered * width, zero);
            let place = middle + quad.offset;
            let nearer = min(place - quad.rear_end, quad.front_end - place);
            let near = touching.select(nearer, far);
            nearest = min(nearest, near);
            farthest = max(farthest, touching.select(nearer, zero));
            *along = near.to_array();
            *distance = max(min(near, from_side), zero).to_array();
        }
        let (nearest, farthest) = (min_lane(nearest), max_lane(farthest));
        farthest * farthest - nearest * nearest
    }

    /// Turns distances to ends and sides into Euclidean distances to the border, for any shape of the contact.
    fn correct_distances(&mut self, terrain: &Terrain, row: usize, spread: f64) {
        let mask = self.masks[row];
        if mask.count_ones() as usize != self.across.lanes {
            for (start, end) in lanes_in_runs(mask) {
                self.find_sides(terrain, start, end);
            }
        }
        if spread > terrain.dy * terrain.dy {
            self.look_across(terrain, spread);
        }
    }

    /// Computes the distances to the ends of a run, in a strip with lanes out of contact.
    fn find_sides(&mut self, terrain: &Terrain, start: usize, end: usize) {
        for lane in start..end {
            let side = &mut self.distance[lane / PACK][lane % PACK];
            if end < self.across.lanes {
                *side = side.min((end as f64 - lane as f64 - 0.5) * terrain.dy);
            }
            if start > 0 {
                *side = side.min((lane as f64 - start as f64 + 0.5) * terrain.dy);
            }
        }
    }

    /// Limits distances by those of neighbouring lanes, where the ends of the contact are oblique.
    ///
    /// `spread` is the difference of the squares of the maximum and the minimum distance along the travel: a neighbour k
    /// lanes away matters only if (k dy)² is less.
    fn look_across(&mut self, terrain: &Terrain, spread: f64) {
        let lanes = self.across.packs() * PACK;
        let farthest = ((spread.sqrt() / terrain.dy) as usize).min(lanes);
        let (right, rest) = self.squares.split_at_mut(lanes);
        let (middle, left) = rest.split_at_mut(lanes);
        for (square, along) in middle.iter_mut().zip(self.along.as_flattened()) {
            *square = along * along;
        }
        left[..farthest].fill(f64::MAX);
        for (beyond, square) in right.iter_mut().rev().zip(middle).take(farthest) {
            *beyond = if terrain.mirrored { *square } else { f64::MAX };
        }
        for distance in &mut self.distance {
            *distance = (Pack::new(*distance) * Pack::new(*distance)).to_array();
        }
        for step in 1..=farthest {
            let across = step as f64 * terrain.dy;
            let across = splat(across * across);
            let right = self.squares[lanes - step..2 * lanes - step].as_chunks().0;
            let left = self.squares[lanes + step..2 * lanes + step].as_chunks().0;
            for ((square, right), left) in self.distance.iter_mut().zip(right).zip(left) {
                let nearer = min(Pack::new(*right), Pack::new(*left));
                *square = min(Pack::new(*square), nearer + across).to_array();
            }
        }
        for distance in &mut self.distance {
            *distance = Pack::new(*distance).sqrt().to_array();
        }
    }

    /// Computes shapes and z^n of a strip's nodes, and the sums over its patch.
    fn find_shapes(&mut self, laws: &Laws, row: usize) {
        let packs = self.across.packs();
        let (mut areas, mut shapes) = (splat(0.0), splat(0.0));
        let quads = &mut self.quads[row * packs..(row + 1) * packs];
        for (quad, distance) in quads.iter_mut().zip(&self.distance) {
            quad.shape = laws.shape(Pack::new(*distance));
            quad.depth_power = laws.depth_power(quad.depth);
            areas += quad.area;
            shapes += quad.area * quad.shape;
        }
        let Patches {
            runs,
            patches,
            by_strip,
            ..
        } = &mut self.patches;
        let runs = &runs[by_strip[row - self.first].clone()];
        if let [run] = runs {
            patches[run.patch].areas += areas;
            patches[run.patch].shapes += shapes;
            return;
        }
        for run in runs {
            let patch = &mut patches[run.patch];
            for (pack, quad) in quads.iter().enumerate() {
                let area = run.lanes_of(pack).select(quad.area, splat(0.0));
                patch.areas += area;
                patch.shapes += area * quad.shape;
            }
        }
    }
}
