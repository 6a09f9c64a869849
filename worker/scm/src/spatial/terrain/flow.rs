//! Flow: yielding soil is lowered, and a share of it flows to the border of the footprint.

use super::super::contact::Contact;
use super::super::contact::laws::Laws;
use super::super::pack::{LANES, PACK, Pack, lanes_of, load, max, splat, store, sum};
use super::super::wheel::motion::Motion;
use super::Terrain;

/// Share of the flow that is isotropic; the rest follows the wheel's motion.
const ISOTROPIC: f64 = 0.5;

/// Buffers of the flow, and the changes of the terrain in a step.
#[derive(Debug, Clone, Default)]
pub(crate) struct Flow {
    /// Sums over nodes of the pressed height, and of the height that flowed to the border `[m]`; times dx dy: volumes.
    pub(crate) pressed: f64,
    pub(crate) flowed: f64,
    forwards: Vec<Pack>,
    backwards: Vec<Pack>,
}

/// Weights of the directions in which soil leaves the footprint.
struct Ways {
    forward: Pack,
    backward: Pack,
    left: Pack,
    right: Pack,
}

impl Flow {
    /// Deforms the terrain after a step at the last trial height.
    pub(crate) fn deform(
        &mut self,
        contact: &Contact,
        terrain: &mut Terrain,
        laws: &Laws,
        motion: &Motion,
        flow_fraction: f64,
    ) {
        let zero = splat(0.0);
        let across = &contact.across;
        let packs = across.packs();
        let whole = u64::MAX >> (u64::BITS as usize - across.lanes);
        let (stiffness, compliance) = (splat(laws.elastic_stiffness), splat(1.0 / laws.elastic_stiffness));
        let fraction = splat(flow_fraction);
        let min_width = splat(0.4999 * terrain.dy);
        let (mut pressed, mut flowed) = (zero, 0.0);
        self.forwards.clear();
        self.forwards.resize(packs, zero);
        // only strips that shape the soil write here, and only their entries are read
        self.backwards.resize(contact.strips.len() * packs, zero);
        // The order from rear to front carries the forward flow along.
        for row in contact.first..contact.end {
            let (strip, mask) = (&contact.strips[row], contact.masks[row]);
            let start = strip.column * terrain.lanes + across.first_lane;
            // if the strip behind is not in contact either, all flow has left already
            if mask != whole && mask | contact.masks[row - 1] != 0 {
                flowed += leave(terrain, start, mask, &mut self.forwards);
            }
            if mask == 0 || !strip.holds_node {
                continue;
            }
            let ways = ways(motion, strip.ahead, strip.rise);
            let (hub, middle) = (splat(contact.hub), splat(strip.middle));
            let (mut leftwards, mut rightwards) = (zero, zero);
            let backwards = &mut self.backwards[row * packs..(row + 1) * packs];
            let quads = &contact.quads[row * packs..(row + 1) * packs];
            let under = terrain.surface[start..start + packs * PACK].as_chunks_mut().0;
            let passing = self.forwards.iter_mut().zip(backwards);
            let sides = across.per_left.iter().zip(&across.per_right);
            for ((((quad, surface), &width), (forward, backward)), (&per_left, &per_right)) in
                quads.iter().zip(under).zip(&across.width).zip(passing).zip(sides)
            {
                let sunk = max(quad.surface - hub - quad.pressure * compliance, zero);
                // Soil on its elastic line keeps its height. Without this test a partly covered cell, whose pressure is not
                // evaluated at its node, would sink at every step, however short.
                let yields = quad.pressure.simd_lt(stiffness * quad.pressed);
                let sunk = (width.simd_gt(min_width) & yields).select(sunk, zero);
                let moves = sunk.simd_gt(zero);
                *backward = zero;
                if moves.none() {
                    continue;
                }
                *surface = (Pack::new(*surface) - sunk).to_array();
                pressed += sunk;
                // The share of each direction decreases with its length.
                let to_front = ways.forward / (quad.front_end - middle);
                let to_rear = ways.backward / (middle - quad.rear_end);
                let (to_left, to_right) = (ways.left * per_left, ways.right * per_right);
                let share = sunk * fraction / (to_front + to_rear + to_left + to_right);
                *forward += moves.select(share * to_front, zero);
                *backward = moves.select(share * to_rear, zero);
                leftwards += moves.select(share * to_left, zero);
                rightwards += moves.select(share * to_right, zero);
            }
            let (leftwards, rightwards) = (sum(leftwards), sum(rightwards));
            let left = across.first_lane + across.lanes;
            // flow from the other half to its far side arrives here; it equals the flow that leaves this half
            let right = if terrain.mirrored {
                left
            } else {
                across.first_lane - 1
            };
            terrain.deposit(strip.column, left, leftwards);
            terrain.deposit(strip.column, right, rightwards);
            flowed += leftwards + rightwards;
        }
        let start = |row: usize| contact.strips[row].column * terrain.lanes + across.first_lane;
        let (ahead, behind) = (start(contact.end), start(contact.first - 1));
        flowed += leave(terrain, ahead, 0, &mut self.forwards);
        // The backward flow goes from front to rear. All forward flow has left, so its buffer is free.
        let passing = &mut self.forwards;
        for row in (contact.first..contact.end).rev() {
            let (strip, mask) = (&contact.strips[row], contact.masks[row]);
            if mask != whole && mask | contact.masks[row + 1] != 0 {
                let start = strip.column * terrain.lanes + across.first_lane;
                flowed += leave(terrain, start, mask, passing);
            }
            if mask == 0 || !strip.holds_node {
                continue;
            }
            let backward = &self.backwards[row * packs..(row + 1) * packs];
            for (passing, backward) in passing.iter_mut().zip(backward) {
                *passing += *backward;
            }
        }
        flowed += leave(terrain, behind, 0, passing);
        self.pressed += sum(pressed);
        self.flowed += flowed;
    }
}

/// Deposits the moving soil where it reaches lanes of a strip that are not in contact; returns the amount.
fn leave(terrain: &mut Terrain, start: usize, mask: u64, passing: &mut [Pack]) -> f64 {
    let mut left = 0.0;
    for (pack, passing) in passing.iter_mut().enumerate() {
        let touching = mask >> (pack * PACK) & LANES;
        if touching != LANES && passing.simd_gt(splat(0.0)).any() {
            let touches = lanes_of(touching);
            left += add(terrain, start + pack * PACK, touches.select(splat(0.0), *passing));
            *passing = touches.select(*passing, splat(0.0));
        }
    }
    left
}

/// Returns the directions of the soil's flow: pushed ahead where the wheel's surface moves into the soil, dragged along
/// by its sliding.
fn ways(motion: &Motion, ahead: f64, rise: f64) -> Ways {
    let per_radius = 1.0 / (ahead * ahead + rise * rise).sqrt();
    let (sin, cos) = (ahead * per_radius, rise * per_radius);
    let velocity = motion.surface_velocity(ahead, rise);
    let normal = (velocity[0] * sin - velocity[2] * cos).max(0.0);
    let along = [(velocity[0] * cos + velocity[2] * sin) * cos, velocity[1]];
    let travel = (motion.forward * motion.forward + motion.lateral * motion.lateral).sqrt();
    let scale = normal + (along[0] * along[0] + along[1] * along[1]).sqrt() + f64::MIN_POSITIVE;
    let x = (normal * motion.forward / travel + along[0]) / scale;
    let y = (normal * motion.lateral / travel + along[1]) / scale;
    let weight = |component: f64| splat(ISOTROPIC + component.max(0.0));
    Ways {
        forward: weight(x),
        backward: weight(-x),
        left: weight(y),
        right: weight(-y),
    }
}

/// Adds soil to four lanes; returns the amount.
fn add(terrain: &mut Terrain, at: usize, heights: Pack) -> f64 {
    let total = sum(heights);
    if total > 0.0 {
        let surface = load(&terrain.surface, at) + heights;
        store(&mut terrain.surface, at, surface);
        let loose = load(&terrain.loose, at) + heights;
        store(&mut terrain.loose, at, loose);
        terrain.top = surface.to_array().into_iter().fold(terrain.top, f64::max);
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the weights forward, backward, left and right at a place ahead of the axle.
    fn weights(motion: &Motion, ahead: f64) -> [f64; 4] {
        let rise = (0.125 * 0.125 - ahead * ahead).sqrt();
        let ways = ways(motion, ahead, rise);
        [ways.forward, ways.backward, ways.left, ways.right].map(|way| way.to_array()[0])
    }

    #[test]
    fn soil_goes_where_the_wheel_pushes_and_drags_it() {
        // rolling without slip at 10 mm/s: soil ahead is pushed ahead
        let mut motion = Motion {
            forward: 0.01,
            lateral: 0.0,
            rotation: 0.01 / 0.125,
        };
        let [forward, backward, left, right] = weights(&motion, 0.03);
        assert!(forward > 1.5 * backward, "{forward} {backward}");
        assert!((left - right).abs() < f64::EPSILON);
        // spinning: soil under the axle is dragged back
        motion.rotation = 0.05 / 0.125;
        let [forward, backward, ..] = weights(&motion, 0.0);
        assert!(backward > 1.5 * forward, "{forward} {backward}");
        // locked: it is dragged along
        motion.rotation = 0.0;
        let [forward, backward, ..] = weights(&motion, 0.0);
        assert!(forward > 1.5 * backward, "{forward} {backward}");
        // sideways to the left
        motion.lateral = 0.02;
        let [_, _, left, right] = weights(&motion, 0.0);
        assert!(left > 1.5 * right, "{left} {right}");
    }
}
