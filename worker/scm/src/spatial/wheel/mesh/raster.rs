//! The lowest point of the wheel above each of a grid of samples.

use super::super::super::pack::PACK;
use super::super::super::terrain::Terrain;
use super::super::across::Across;
use super::super::envelope::NOWHERE;
use super::super::pose::{Pose, Range};
use super::triangle::Placed;

/// Displacement by rounding, in samples or lanes.
const ROUNDING: f64 = 1e-6;
/// Difference of rises `[m]` or squared slopes that rounding can cause.
const SAME: f64 = 1e-12;
/// Distance at which a lane lies on an edge, so that both triangles count `[m]`.
const ON_EDGE: f64 = 1e-14;

/// A z-buffer: samples along travel, at equal distances and with the same number in every column, times lanes.
#[derive(Debug, Clone, Default)]
pub(super) struct Raster {
    /// Number of samples of a column.
    pub(super) per_column: usize,
    pub(super) samples: usize,
    /// Number of lanes under the wheel, and with padding of the last pack.
    pub(super) lanes: usize,
    pub(super) stride: usize,
    /// Place of the first sample ahead of the hub, and distance from each to the next `[m]`.
    first: f64,
    pub(super) spacing: f64,
    /// y of each lane from the wheel's middle plane, in the middle of its covered part `[m]`.
    middles: Vec<f64>,
    /// Number of lanes per length across `[1/m]`.
    per_dy: f64,
    /// For each sample and lane, the largest rise `[m]`, or [`NOWHERE`], and the slopes dh/dx, dh/dy there.
    pub(super) rise: Vec<f64>,
    pub(super) slope_x: Vec<f64>,
    pub(super) slope_y: Vec<f64>,
}

impl Raster {
    /// Clears the buffer for a range of columns.
    pub(super) fn clear(
        &mut self,
        terrain: &Terrain,
        pose: Pose,
        range: Range,
        per_column: usize,
        across: &Across,
    ) {
        self.per_column = per_column;
        self.samples = range.end.saturating_sub(range.start) * per_column;
        self.lanes = across.lanes;
        self.stride = across.packs() * PACK;
        self.spacing = terrain.dx / per_column as f64;
        self.first = terrain.x(range.start) - pose.x - 0.5 * (terrain.dx - self.spacing);
        self.per_dy = 1.0 / terrain.dy;
        self.middles.clear();
        for pack in 0..across.packs() {
            let (left, right) = (
                across.from_left[pack].to_array(),
                across.from_right[pack].to_array(),
            );
            let middle = |i: usize| 0.5 * (right[i] - left[i]);
            let lanes = (self.lanes - pack * PACK).min(PACK);
            self.middles.extend((0..lanes).map(middle));
        }
        for (buffer, value) in [
            (&mut self.rise, NOWHERE),
            (&mut self.slope_x, 0.0),
            (&mut self.slope_y, 0.0),
        ] {
            buffer.clear();
            buffer.resize(self.samples * self.stride, value);
        }
    }

    /// Returns the place of a sample ahead of the hub `[m]`.
    #[inline]
    pub(super) fn ahead(&self, sample: usize) -> f64 {
        self.first + sample as f64 * self.spacing
    }

    /// Keeps a triangle where it is lower than earlier ones.
    ///
    /// Edges belong to both triangles that share them, and both find the same points on them, so there are no holes.
    pub(super) fn draw(&mut self, placed: &Placed) {
        let [a, b, c] = placed.corners;
        let (long, rear, front) = (Edge::new(a, c), Edge::new(a, b), Edge::new(b, c));
        let start = ((a[0] - self.first) / self.spacing - ROUNDING).max(0.0) as usize;
        for sample in start..self.samples {
            let x = self.ahead(sample);
            if x > c[0] {
                break;
            }
            if x < a[0] {
                continue;
            }
            let one = long.at(x);
            let other = if x < b[0] { rear.at(x) } else { front.at(x) };
            self.draw_row(placed, sample, x, one.min(other), one.max(other));
        }
    }

    /// Keeps a triangle over the lanes from y = `low` to `high` of a sample.
    #[inline]
    fn draw_row(&mut self, placed: &Placed, sample: usize, x: f64, low: f64, high: f64) {
        let [a, ..] = placed.corners;
        let Some(&bottom) = self.middles.first() else {
            return;
        };
        let [per_x, per_y] = placed.descent;
        let row = sample * self.stride;
        // The outermost lanes may be narrower, so the guess may be one lane too low.
        let guess = ((low - bottom) * self.per_dy - ROUNDING).max(0.0) as usize;
        for lane in guess..self.lanes {
            let y = self.middles[lane];
            if y > high + ON_EDGE {
                break;
            }
            if y < low - ON_EDGE {
                continue;
            }
            let rise = a[2] + per_x * (x - a[0]) + per_y * (y - a[1]);
            // rounding on a steep plane must not leave the triangle
            let rise = rise.max(placed.min_rise).min(placed.max_rise);
            let place = row + lane;
            let lower = rise - self.rise[place];
            if lower > SAME {
                self.rise[place] = rise;
                [self.slope_x[place], self.slope_y[place]] = placed.slopes;
            } else if lower > -SAME {
                self.share(place, placed.slopes);
            }
        }
    }
}

impl Raster {
    /// Keeps on an edge the slopes of the less steep triangle; for equal slopes, the mean. A mirror image gives the same.
    #[cold]
    fn share(&mut self, place: usize, slopes: [f64; 2]) {
        let (x, y) = (self.slope_x[place], self.slope_y[place]);
        let steeper = (slopes[0] * slopes[0] + slopes[1] * slopes[1]) - (x * x + y * y);
        if steeper < -SAME {
            [self.slope_x[place], self.slope_y[place]] = slopes;
        } else if steeper <= SAME {
            self.slope_x[place] = 0.5 * (x + slopes[0]);
            self.slope_y[place] = 0.5 * (y + slopes[1]);
        }
    }
}

/// An edge of a triangle, from rear to front: y = start + slope (x − from).
#[derive(Debug, Clone, Copy)]
struct Edge {
    from: f64,
    start: f64,
    slope: f64,
}

impl Edge {
    fn new(a: [f64; 3], b: [f64; 3]) -> Self {
        let length = b[0] - a[0];
        Self {
            from: a[0],
            start: a[1],
            slope: if length > 0.0 { (b[1] - a[1]) / length } else { 0.0 },
        }
    }

    #[inline]
    fn at(self, x: f64) -> f64 {
        self.start + self.slope * (x - self.from)
    }
}
