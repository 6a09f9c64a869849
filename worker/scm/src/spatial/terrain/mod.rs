//! The soil as a height field on a regular grid.
//!
//! # Layout
//! - `flow`: yielding soil is lowered, and a share of it flows to the border of the footprint.
//! - `digging`: soil that the sliding wheel carries away from under itself.
//! - `relaxation`: slopes steeper than the angle of repose slide.

pub(super) mod digging;
pub(super) mod flow;
pub(super) mod relaxation;

use super::pack::PACK;

/// Number of lanes for berms beside the wheel.
pub(crate) const BERM_LANES: usize = 6;

/// A digital elevation model of columns (across the travel of the wheel's heading) and lanes (along it).
///
/// Column i has its node at `(i + 1/2) dx`, lane j at `first_y + j dy`. A mirrored terrain holds the half
/// y > 0 of a scene that is symmetric about the wheel's middle plane. Lanes of a column are neighbours in memory.
///
/// The yield pressure of a node is not stored: it follows from the depth of the surface below the reference, because a node
/// unloads along the elastic line on which it was left.
#[derive(Debug, Clone)]
pub(crate) struct Terrain {
    /// Spacing along x `[m]`.
    pub(crate) dx: f64,
    /// Spacing along y `[m]`.
    pub(crate) dy: f64,
    /// y of lane 0 `[m]`.
    pub(crate) first_y: f64,
    pub(crate) columns: usize,
    /// Number of lanes of a column, a multiple of [`PACK`].
    pub(crate) lanes: usize,
    pub(crate) mirrored: bool,
    /// Present height of each node above the undisturbed surface `[m]`.
    pub(crate) surface: Vec<f64>,
    /// Net thickness of loose soil that flowed to the node `[m]`; negative if it flowed away.
    pub(crate) loose: Vec<f64>,
    /// Accumulated shear displacement of each node `[m]`.
    pub(crate) sheared: Vec<f64>,
    /// Depth by which the reference surface of each node was dug down `[m]`; empty without digging.
    pub(crate) dug: Vec<f64>,
    /// The highest surface so far `[m]`.
    pub(crate) top: f64,
}

impl Terrain {
    /// Creates undisturbed soil.
    pub(crate) fn new(dx: f64, dy: f64, first_y: f64, columns: usize, lanes: usize, mirrored: bool) -> Self {
        let lanes = lanes.next_multiple_of(PACK);
        let nodes = columns * lanes;
        Self {
            dx,
            dy,
            first_y,
            columns,
            lanes,
            mirrored,
            surface: vec![0.0; nodes],
            loose: vec![0.0; nodes],
            sheared: vec![0.0; nodes],
            dug: Vec::new(),
            top: 0.0,
        }
    }

    /// Returns x of a column `[m]`.
    #[inline]
    pub(crate) fn x(&self, column: usize) -> f64 {
        (column as f64 + 0.5) * self.dx
    }

    /// Returns y of a lane `[m]`.
    #[inline]
    pub(crate) fn y(&self, lane: usize) -> f64 {
        self.first_y + lane as f64 * self.dy
    }

    /// Adds soil to a node.
    #[inline]
    pub(crate) fn deposit(&mut self, column: usize, lane: usize, height: f64) {
        let node = column * self.lanes + lane;
        self.surface[node] += height;
        self.loose[node] += height;
        if self.surface[node] > self.top {
            self.top = self.surface[node];
        }
    }
}
