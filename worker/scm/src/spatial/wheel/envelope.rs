//! The underside of a wheel over the columns of the terrain.

use super::super::pack::Pack;

/// The rise beside the wheel `[m]`: that of a surface 1 km above the hub, which no soil touches.
pub(crate) const NOWHERE: f64 = -1e3;

/// A piece of one column of the terrain under one piece of the wheel, measured ahead of the hub `[m]`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strip {
    /// The terrain's column.
    pub(crate) column: usize,
    pub(crate) rear: f64,
    pub(crate) middle: f64,
    pub(crate) front: f64,
    /// Place of rise and slope: the column's node on a smooth wheel, else the middle.
    pub(crate) ahead: f64,
    /// Height of the hub above the wheel's surface `[m]`; [`NOWHERE`] beside the wheel.
    pub(crate) rise: f64,
    /// Slope dh/dx of the wheel's surface `[–]`.
    pub(crate) slope: f64,
    /// True if the column's node lies in this strip, so that the strip shapes it.
    pub(crate) holds_node: bool,
    /// True if the whole column lies under one smooth surface that continues into neighbours of the same kind.
    pub(crate) smooth: bool,
}

/// The wheel's surface over four lanes of a strip, if lanes differ.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facet {
    pub(crate) rise: Pack,
    pub(crate) slope_x: Pack,
    pub(crate) slope_y: Pack,
}

impl Facet {
    /// Creates facets beside the wheel.
    pub(crate) fn none() -> Self {
        Self {
            rise: Pack::splat(NOWHERE),
            slope_x: Pack::splat(0.0),
            slope_y: Pack::splat(0.0),
        }
    }
}

/// The wheel's lowest points over a range of columns without gaps, from rear to front.
#[derive(Debug, Clone, Default)]
pub(crate) struct Envelope {
    pub(crate) strips: Vec<Strip>,
    /// For a wheel whose lanes differ: packs of lanes, each with all its strips; empty if lanes are alike.
    pub(crate) facets: Vec<Facet>,
}
