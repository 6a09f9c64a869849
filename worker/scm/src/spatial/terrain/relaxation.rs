//! Relaxation: slopes steeper than the angle of repose slide.

use super::super::contact::Contact;
use super::super::pack::{PACK, Pack, max, min, splat};
use super::{BERM_LANES, Terrain};

/// Share of an edge's excess height that moves in one sweep; above 1/4 a checkerboard pattern would grow.
const RATE: f64 = 0.25;
/// Number of columns behind the contact within which soil slides at every step.
const BEHIND: usize = 1;
/// Number of columns ahead of the contact within which soil slides at every step.
const AHEAD: usize = 5;
/// Number of sweeps over these columns at every step.
const SWEEPS: usize = 1;
/// Number of sweeps over the whole track before the wheel passes again.
const SWEEPS_BETWEEN_PASSES: usize = 40;

/// Buffers of the relaxation.
#[derive(Debug, Clone, Default)]
pub(crate) struct Relaxation {
    tan_repose: f64,
    /// Room between each node and the wheel above it `[m]`.
    room: Vec<f64>,
    /// Heights that move from one column to the next `[m]`.
    along: Vec<Pack>,
}

/// Columns and lanes within which soil may slide; the lanes are whole packs.
#[derive(Debug, Clone, Copy)]
struct Window {
    columns: [usize; 2],
    lanes: [usize; 2],
}

impl Window {
    fn packs(&self) -> usize {
        (self.lanes[1] - self.lanes[0]) / PACK
    }

    /// Returns the number of lanes of a column in a buffer, with padding behind the last.
    fn stride(&self) -> usize {
        self.lanes[1] - self.lanes[0] + PACK
    }
}

impl Relaxation {
    pub(crate) fn new(repose_angle_rad: f64) -> Self {
        Self {
            tan_repose: libm::tan(repose_angle_rad),
            ..Self::default()
        }
    }

    /// Lets the soil around the contact slide, but never into the wheel.
    ///
    /// Every sweep moves over each edge a share of the excess over the angle of repose, all computed from the surface before
    /// the sweep (Jacobi), so that left and right are alike and no soil is lost.
    pub(crate) fn relax(&mut self, terrain: &mut Terrain, contact: &Contact, hub: f64) {
        let across = &contact.across;
        let first = contact.strips[contact.first].column;
        let last = contact.strips[contact.end - 1].column;
        let low = across.first_lane.saturating_sub(BERM_LANES);
        let lanes = (across.first_lane + across.lanes + BERM_LANES - low).next_multiple_of(PACK);
        let window = Window {
            columns: [first - BEHIND, last + 1 + AHEAD],
            lanes: [low, low + lanes],
        };
        self.find_room(terrain, contact, hub, window);
        for _ in 0..SWEEPS {
            self.sweep(terrain, window);
        }
    }

    /// Lets every slope of the terrain slide, away from the wheel.
    pub(crate) fn relax_everywhere(&mut self, terrain: &mut Terrain) {
        let window = Window {
            columns: [0, terrain.columns - 1],
            lanes: [0, terrain.lanes - PACK],
        };
        self.make_room(window);
        for _ in 0..SWEEPS_BETWEEN_PASSES {
            self.sweep(terrain, window);
        }
    }

    fn make_room(&mut self, window: Window) {
        self.room.clear();
        self.room.resize(
            (window.columns[1] - window.columns[0] + 1) * window.stride(),
            f64::MAX,
        );
    }

    fn find_room(&mut self, terrain: &Terrain, contact: &Contact, hub: f64, window: Window) {
        self.make_room(window);
        let across = &contact.across;
        let lanes = across.packs() * PACK;
        for (row, strip) in contact.strips.iter().enumerate() {
            if !strip.holds_node || strip.column < window.columns[0] || strip.column >= window.columns[1] {
                continue;
            }
            let start = strip.column * terrain.lanes + across.first_lane;
            let place =
                (strip.column - window.columns[0]) * window.stride() + across.first_lane - window.lanes[0];
            let room = packs_mut(&mut self.room, place, lanes);
            for (pack, ((room, surface), bias)) in room
                .iter_mut()
                .zip(packs(&terrain.surface, start, lanes))
                .zip(&across.bias)
                .enumerate()
            {
                let rise = contact.rise(row * across.packs() + pack, row);
                let height = splat(hub) - rise - *bias - Pack::new(*surface);
                *room = max(height, splat(0.0)).to_array();
            }
        }
    }

    /// Sweeps column by column and lane by lane, in place: the amount that moves over an edge is computed before either of
    /// its nodes has changed.
    fn sweep(&mut self, terrain: &mut Terrain, window: Window) {
        let [first, end] = window.columns;
        let (packs, stride, zero) = (window.packs(), window.stride(), splat(0.0));
        // slopes at the window's sides count as stable, so that nothing flows over them
        let (steepest_x, steepest_y) = (terrain.dx * self.tan_repose, terrain.dy * self.tan_repose);
        let last_y = Pack::new([steepest_y, steepest_y, steepest_y, f64::MAX]);
        let steepest_y = splat(steepest_y);
        self.along.clear();
        self.along.resize(packs, zero);
        for column in first..end {
            let steepest_x = splat(if column + 1 < end { steepest_x } else { f64::MAX });
            let start = column * terrain.lanes + window.lanes[0];
            let (current, next) = terrain.surface[start..].split_at_mut(terrain.lanes);
            let (current, next) = (
                &mut current.as_chunks_mut().0[..=packs],
                &next.as_chunks().0[..packs],
            );
            let loose = &mut terrain.loose[start..].as_chunks_mut().0[..packs];
            let (room, next_room) = self.room[(column - first) * stride..].split_at_mut(stride);
            let (room, next_room) = (
                &mut room.as_chunks_mut().0[..=packs],
                &next_room.as_chunks().0[..packs],
            );
            let along = &mut self.along[..packs];
            let mut aside = 0.0; // from the last lane of the pack before
            for pack in 0..packs {
                let steepest_y = if pack + 1 < packs { steepest_y } else { last_y };
                let (height, inward) = (Pack::new(current[pack]), along[pack]);
                let drop_x = height - Pack::new(next[pack]);
                let drop_y = height - beside(current[pack], current[pack + 1]);
                let steep = drop_x.abs().simd_gt(steepest_x) | drop_y.abs().simd_gt(steepest_y);
                if (steep | inward.simd_ne(zero)).none() && aside == 0.0 {
                    continue;
                }
                let space = Pack::new(room[pack]);
                let out = edge(drop_x, steepest_x, space, Pack::new(next_room[pack]));
                let over = edge(drop_y, steepest_y, space, beside(room[pack], room[pack + 1]));
                let [a, b, c, d] = over.to_array();
                let change = (Pack::new([aside, a, b, c]) - over) + (inward - out);
                (along[pack], aside) = (out, d);
                current[pack] = (height + change).to_array();
                loose[pack] = (Pack::new(loose[pack]) + change).to_array();
                room[pack] = (space - change).to_array();
            }
        }
    }
}

/// Returns four lanes shifted by one: the last three, and the first of the lanes after them.
#[inline]
fn beside(lanes: [f64; PACK], after: [f64; PACK]) -> Pack {
    Pack::new([lanes[1], lanes[2], lanes[3], after[0]])
}

/// Returns a row of lanes in packs.
#[inline]
fn packs(row: &[f64], start: usize, lanes: usize) -> &[[f64; PACK]] {
    row[start..start + lanes].as_chunks().0
}

#[inline]
fn packs_mut(row: &mut [f64], start: usize, lanes: usize) -> &mut [[f64; PACK]] {
    row[start..start + lanes].as_chunks_mut().0
}

/// Returns the height that moves over an edge, > 0 towards the second node; never more than a quarter of the room at
/// its target.
#[inline]
fn edge(drop: Pack, steepest: Pack, room: Pack, next_room: Pack) -> Pack {
    let (rate, quarter, zero) = (splat(RATE), splat(0.25), splat(0.0));
    let down = max(min(rate * (drop - steepest), quarter * next_room), zero);
    let up = max(min(rate * (zero - drop - steepest), quarter * room), zero);
    down - up
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: f64 = 0.004;

    /// Returns a heap of a given height in the middle of flat soil.
    fn heap(height: f64) -> Terrain {
        let mut terrain = Terrain::new(SPACING, SPACING, -12.0 * SPACING, 24, 24, false);
        terrain.deposit(12, 12, height);
        terrain
    }

    fn steepest(terrain: &Terrain) -> f64 {
        let at = |column: usize, lane: usize| terrain.surface[column * terrain.lanes + lane];
        let mut steepest = 0.0_f64;
        for column in 0..terrain.columns - 1 {
            for lane in 0..terrain.lanes - 1 {
                let height = at(column, lane);
                let drops = [height - at(column + 1, lane), height - at(column, lane + 1)];
                steepest = drops.iter().fold(steepest, |max, d| max.max(d.abs() / SPACING));
            }
        }
        steepest
    }

    #[test]
    fn a_heap_slides_to_the_angle_of_repose_and_loses_nothing() {
        let repose = 32_f64.to_radians();
        let mut terrain = heap(0.05);
        let mut relaxation = Relaxation::new(repose);
        let mut before = steepest(&terrain);
        for _ in 0..20 {
            relaxation.relax_everywhere(&mut terrain);
            let after = steepest(&terrain);
            assert!(after <= before, "{after} after {before}");
            before = after;
        }
        // the excess over the angle of repose decays exponentially: a thousandth remains
        assert!(before < repose.tan() * 1.001, "{before}");
        let left: f64 = terrain.surface.iter().sum();
        assert!((left - 0.05).abs() < 1e-15, "{left}");
        assert!(terrain.surface.iter().all(|&z| z >= 0.0));
    }

    #[test]
    fn a_slope_below_the_angle_of_repose_stays_to_the_last_bit() {
        let mut terrain = heap(SPACING * 0.6);
        let before = terrain.surface.clone();
        Relaxation::new(32_f64.to_radians()).relax_everywhere(&mut terrain);
        assert_eq!(before, terrain.surface);
    }

    #[test]
    fn a_heap_slides_alike_to_all_four_sides() {
        let mut terrain = heap(0.05);
        Relaxation::new(0.5).relax_everywhere(&mut terrain);
        let at = |column: usize, lane: usize| terrain.surface[column * terrain.lanes + lane];
        for k in 1..6 {
            let sides = [at(12 + k, 12), at(12 - k, 12), at(12, 12 + k), at(12, 12 - k)];
            assert!(sides.iter().all(|z| (z - sides[0]).abs() < 1e-17), "{sides:?}");
        }
        assert!(at(13, 12) > 0.0);
    }

    #[test]
    fn no_soil_slides_to_where_there_is_no_room() {
        let mut terrain = heap(0.05);
        let mut relaxation = Relaxation::new(0.5);
        let window = Window {
            columns: [0, 23],
            lanes: [0, 20],
        };
        relaxation.make_room(window);
        // the column in front of the heap has room for 2 mm
        for lane in 0..20 {
            relaxation.room[13 * window.stride() + lane] = 2e-3;
        }
        for _ in 0..200 {
            relaxation.sweep(&mut terrain, window);
        }
        let lanes = |column: usize| &terrain.surface[column * 24..(column + 1) * 24];
        let highest = |column: usize| lanes(column).iter().copied().fold(0.0_f64, f64::max);
        assert!((1.9e-3..2e-3 + 1e-15).contains(&highest(13)), "{}", highest(13));
        assert!(highest(11) > 2e-3, "behind the heap nothing is in the way");
        assert!((terrain.surface.iter().sum::<f64>() - 0.05).abs() < 1e-15);
    }
}
