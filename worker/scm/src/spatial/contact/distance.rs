//! The geometry of a footprint: ends of the contact between nodes, areas, distances from the border.

use super::super::pack::{LANES, PACK, Pack, greater, least_of, lesser, most_of, splat, sum};
use super::super::terrain::Terrain;
use super::Contact;
use super::laws::Laws;
use super::patch::{Patches, lanes_in_runs};

/// Distance along the travel of a node that is not in contact, where only the least counts.
const FAR: f64 = 1e100;

impl Contact {
    /// Areas, depths and shapes of the nodes in contact, and their sums over each patch.
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

    /// Touch a strip: which nodes are in contact, and the distance to the rear end of their contact.
    pub(crate) fn find_rear_ends(&mut self, row: usize, hub: f64) {
        let packs = self.across.packs();
        let (zero, hub) = (splat(0.0), splat(hub));
        let (strip, previous) = (&self.strips[row], &self.strips[row - 1]);
        let half = splat(strip.middle - strip.rear);
        let gap = splat(strip.middle - previous.middle);
        let smooth = strip.smooth && previous.smooth;
        let (behind, here) = self.quads[(row - 1) * packs..(row + 1) * packs].split_at_mut(packs);
        let mut before = self.masks[row - 1];
        let mut mask = 0;
        for (pack, (quad, behind)) in here.iter_mut().zip(behind).enumerate() {
            let penetration = quad.surface - hub;
            let touching = penetration.simd_gt(zero);
            let lanes = u64::from(touching.to_bitmask());
            mask |= lanes << (pack * PACK);
            let carried = behind.to_rear + gap;
            (quad.penetration, quad.to_rear, quad.left, quad.tilt) = (penetration, carried, half, zero);
            if lanes & !before != 0 {
                let their_penetration = behind.surface - hub;
                let ends = touching & their_penetration.simd_le(zero);
                if smooth {
                    let tilt = (penetration - their_penetration) / gap;
                    quad.left = ends.select(penetration / tilt, half);
                    quad.tilt = ends.select(tilt, zero);
                }
                quad.to_rear = ends.select(quad.left, carried);
            }
            before >>= PACK;
        }
        self.masks[row] = mask;
    }

    /// Distance to the front end of each node's contact, once those of the strip ahead are known, and what follows
    /// from both ends. Gives the difference of the squares of the strip's greatest and least distance along the travel.
    fn find_front_ends(&mut self, row: usize, hub: f64) -> f64 {
        let packs = self.across.packs();
        let (zero, hub) = (splat(0.0), splat(hub));
        let mut begins = self.masks[row] & !self.masks[row + 1];
        let (strip, next) = (&self.strips[row], &self.strips[row + 1]);
        let half = splat(strip.front - strip.middle);
        let gap = splat(next.middle - strip.middle);
        let smooth = strip.smooth && next.smooth;
        let (mut nearest, mut farthest) = (splat(FAR), zero);
        let (here, ahead) = self.quads[row * packs..(row + 2) * packs].split_at_mut(packs);
        let across = self.across.width.iter().zip(&self.across.from_side);
        let distances = self.along.iter_mut().zip(&mut self.distance);
        for (((quad, ahead), (along, distance)), (&width, &from_side)) in
            here.iter_mut().zip(ahead).zip(distances).zip(across)
        {
            let touching = quad.penetration.simd_gt(zero);
            let (mut to_front, mut right, mut tilt) = (ahead.to_front + gap, half, -quad.tilt);
            if begins & LANES != 0 {
                let their_penetration = ahead.surface - hub;
                let ends = touching & their_penetration.simd_le(zero);
                if smooth {
                    let falls = (quad.penetration - their_penetration) / gap;
                    right = ends.select(quad.penetration / falls, half);
                    tilt = ends.select(falls, tilt);
                }
                to_front = ends.select(right, to_front);
            }
            begins >>= PACK;
            // The pressure is taken in the middle of what the node covers.
            let offset = (right - quad.left) * splat(0.5);
            let nearer = lesser(quad.to_rear + offset, to_front - offset);
            let near = touching.select(nearer, splat(FAR));
            nearest = lesser(nearest, near);
            farthest = greater(farthest, touching.select(nearer, zero));
            *along = near.to_array();
            *distance = greater(lesser(near, from_side), zero).to_array();
            quad.to_front = to_front;
            quad.area = touching.select((quad.left + right) * width, zero);
            quad.pressed = quad.penetration - tilt * offset;
            quad.depth = quad.reference - hub - quad.slope * offset;
        }
        let (least, most) = (least_of(nearest), most_of(farthest));
        most * most - least * least
    }

    /// Make distances from ends and sides those from the border: Euclidean, whatever the contact's shape.
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

    /// Distances to the ends of a run, in a strip that is not in contact in every lane.
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

    /// Shorten distances to what neighbouring lanes allow, where the ends of the contact lie at an angle.
    ///
    /// `spread` is the difference of the squares of the greatest and the least distance along the travel: a
    /// neighbour k lanes away can only count if (k dy)² is less.
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
                let nearer = lesser(Pack::new(*right), Pack::new(*left));
                *square = lesser(Pack::new(*square), nearer + across).to_array();
            }
        }
        for distance in &mut self.distance {
            *distance = Pack::new(*distance).sqrt().to_array();
        }
    }

    /// Shapes of a strip's nodes, and the sums over its patch.
    fn find_shapes(&mut self, laws: &Laws, row: usize) {
        let packs = self.across.packs();
        let (mut areas, mut shapes) = (splat(0.0), splat(0.0));
        let quads = &mut self.quads[row * packs..(row + 1) * packs];
        laws.shapes(&mut self.distance);
        for (quad, shape) in quads.iter_mut().zip(&self.distance) {
            quad.shape = Pack::new(*shape);
            areas += quad.area;
            shapes += quad.area * quad.shape;
        }
        let Patches {
            runs,
            patches,
            of_strip,
            ..
        } = &mut self.patches;
        let runs = &runs[of_strip[row - self.first].clone()];
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
