//! The lanes of the terrain that the wheel covers.

use super::super::pack::{PACK, Pack, max, max_lane, splat};
use super::super::terrain::Terrain;
use super::envelope::NOWHERE;

/// The lanes under the wheel, in packs; lanes that only pad the last pack have no width.
#[derive(Debug, Clone, Default)]
pub(crate) struct Across {
    /// The terrain's lane at which the first pack begins.
    pub(crate) first_lane: usize,
    pub(crate) lanes: usize,
    /// Covered width of each lane `[m]`.
    pub(crate) width: Vec<Pack>,
    /// 0 under the wheel, [`NOWHERE`] in the padding lanes `[m]`.
    pub(crate) bias: Vec<Pack>,
    /// Distance of the middle of the covered width from the wheel's side at greater y, and at smaller y `[m]`.
    pub(crate) from_left: Vec<Pack>,
    pub(crate) from_right: Vec<Pack>,
    /// The smaller of the two distances.
    pub(crate) from_side: Vec<Pack>,
    /// One over the distances from either side `[1/m]`.
    pub(crate) per_left: Vec<Pack>,
    pub(crate) per_right: Vec<Pack>,
    /// y of the last placement of the wheel `[m]`.
    laid_at: Option<f64>,
}

impl Across {
    pub(crate) fn packs(&self) -> usize {
        self.width.len()
    }

    /// Returns the width of the wheel `[m]`.
    pub(crate) fn wheel_width(&self) -> f64 {
        let whole = |packs: &[Pack]| packs.first().map_or(0.0, |pack| pack.to_array()[0]);
        whole(&self.from_left) + whole(&self.from_right)
    }

    /// Returns the part of a lane that the wheel covers: from y to y from its middle plane `[m]`.
    pub(crate) fn covered(&self, lane: usize) -> [f64; 2] {
        let value = |packs: &[Pack]| packs[lane / PACK].to_array()[lane % PACK];
        let middle = 0.5 * (value(&self.from_right) - value(&self.from_left));
        let half = 0.5 * value(&self.width);
        [middle - half, middle + half]
    }

    /// Returns the highest surface of a column of the terrain under the wheel `[m]`.
    pub(crate) fn highest(&self, terrain: &Terrain, column: usize) -> f64 {
        let start = column * terrain.lanes + self.first_lane;
        let under = terrain.surface[start..start + self.bias.len() * PACK]
            .as_chunks()
            .0;
        let lanes = under.iter().zip(&self.bias);
        max_lane(lanes.fold(splat(NOWHERE), |high, (z, &bias)| max(high, Pack::new(*z) + bias)))
    }

    /// Places a wheel of a width around y over the lanes, along their borders. In a mirrored terrain the right side is the
    /// image of the left one.
    pub(crate) fn lay(&mut self, terrain: &Terrain, y: f64, width: f64) {
        if self.laid_at == Some(y) {
            return;
        }
        self.laid_at = Some(y);
        let (left, right) = (y + 0.5 * width, y - 0.5 * width);
        let edge = |at: f64| libm::round((at - terrain.first_y) / terrain.dy + 0.5) as usize;
        let low = if terrain.mirrored { 0 } else { edge(right) };
        self.first_lane = low;
        self.lanes = edge(left) - low;
        for column in [
            &mut self.width,
            &mut self.bias,
            &mut self.from_left,
            &mut self.from_right,
            &mut self.from_side,
            &mut self.per_left,
            &mut self.per_right,
        ] {
            column.clear();
        }
        for first in (0..self.lanes).step_by(PACK) {
            let lane = |i: usize| {
                let middle = terrain.y(low + first + i);
                let top = (middle + 0.5 * terrain.dy).min(left);
                let bottom = middle - 0.5 * terrain.dy;
                let bottom = if terrain.mirrored {
                    bottom
                } else {
                    bottom.max(right)
                };
                (top, bottom)
            };
            let covered = |i: usize| first + i < self.lanes;
            let pack = |value: &dyn Fn(usize) -> f64| Pack::new([value(0), value(1), value(2), value(3)]);
            let half = |i: usize| 0.5 * (lane(i).0 + lane(i).1);
            let from_left = pack(&|i| if covered(i) { left - half(i) } else { 0.0 });
            let from_right = pack(&|i| match (covered(i), terrain.mirrored) {
                (false, _) => 0.0,
                (true, true) => half(i) + 0.5 * width,
                (true, false) => half(i) - right,
            });
            self.width
                .push(pack(&|i| if covered(i) { lane(i).0 - lane(i).1 } else { 0.0 }));
            self.bias.push(pack(&|i| if covered(i) { 0.0 } else { NOWHERE }));
            self.from_left.push(from_left);
            self.from_right.push(from_right);
            self.per_left.push(splat(1.0) / from_left);
            self.per_right.push(splat(1.0) / from_right);
            self.from_side.push(from_left.fast_min(from_right));
        }
    }
}
