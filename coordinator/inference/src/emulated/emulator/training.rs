//! The training points of an emulator: evaluations of the model.

use super::coordinates::EmulatorCoordinates;
use super::frame::Frame;

/// Distance from the mean of the target, in its sds, within which a training point counts.
const REACH: f64 = 8.0;

/// Training points for each term of a quadratic trend, and beside these.
const POINTS_A_TERM: usize = 2;
const MORE_POINTS: usize = 24;

/// Largest number of training points beyond what the trend needs.
const MAX_POINTS: usize = 240;

/// An evaluation of the model.
#[derive(Debug, Clone)]
pub(crate) struct TrainingPoint {
    /// The model's parameters in either kind of coordinates.
    pub(crate) coordinates: [Vec<f64>; 2],
    /// The outputs; `None` where the model rejected the parameters.
    pub(crate) outputs: Option<Vec<f64>>,
}

/// A training point in a frame.
pub(crate) struct WhitenedPoint<'a> {
    pub(crate) u: Vec<f64>,
    pub(crate) square: f64,
    pub(crate) outputs: Option<&'a [f64]>,
}

/// Returns the training points near the target, the nearest first: those within reach, at least enough for a quadratic trend.
pub(crate) fn near<'a>(
    points: &'a [TrainingPoint],
    kind: EmulatorCoordinates,
    frame: &Frame,
    terms: usize,
) -> Vec<WhitenedPoint<'a>> {
    let mut whitened: Vec<WhitenedPoint<'a>> = points
        .iter()
        .map(|point| {
            let u = frame.whiten(&point.coordinates[kind as usize]);
            WhitenedPoint {
                square: u.iter().map(|u| u * u).sum(),
                u,
                outputs: point.outputs.as_deref(),
            }
        })
        .collect();
    whitened.sort_by(|a, b| a.square.total_cmp(&b.square));
    let enough = POINTS_A_TERM * terms + MORE_POINTS;
    let within = whitened.partition_point(|point| point.square <= REACH * REACH);
    whitened.truncate(within.clamp(enough, enough.max(MAX_POINTS)));
    whitened
}
