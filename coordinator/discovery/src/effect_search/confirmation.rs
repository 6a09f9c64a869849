//! Confirmation of the best extensions from several starts, to find other modes.

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::LaplaceFit;

/// How many extensions are confirmed at once, the best.
pub(crate) const COUNT: usize = 4;
/// A fit that fell short of its promise has not converged, and its promise is that of a linear model: the best of them are
/// confirmed where that is more than this share of the best.
pub(crate) const STUCK: f64 = 0.6;
/// Beyond the first, an extension is worth its confirmation where it promises more \[nats\].
pub(crate) const LEAST_PROMISE: f64 = 0.0;

/// Starts that fill the prior, where the best fit so far contradicts the data.
pub(crate) const ANYWHERE: usize = 16;

/// Distances of the strength from its neutral value, in standard deviations of its prior: very weak, weak, usual and strong.
const ONE_SIDED: [f64; 4] = [0.05, 0.3, 1.0, 2.0];
const TWO_SIDED: [f64; 4] = [0.5, -0.5, 1.5, -1.5];

/// Starts at the base's fit with the effect added; of a switch, that fit.
pub(crate) fn starts(frame: &NormalFrame, base: &LaplaceFit) -> Vec<Vec<f64>> {
    if frame.is_switch() {
        return vec![base.point.position.clone()];
    }
    let strengths: &[f64] = if frame.is_one_sided() {
        &ONE_SIDED
    } else {
        &TWO_SIDED
    };
    // The shapes take turns, so that each start has another.
    let start = |(n, strength): (usize, &f64)| {
        let mut position = base.point.position.clone();
        position.resize(frame.dimension(), [0.0, 1.0, -1.0][n % 3]);
        for &(k, neutral) in &frame.strengths {
            position[k] = neutral + strength;
        }
        position
    };
    strengths.iter().enumerate().map(start).collect()
}
