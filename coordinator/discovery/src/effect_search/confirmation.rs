//! Confirmation of the best extensions from several starts, to find other modes.

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::LaplaceFit;

/// How many extensions, the best, are confirmed at once.
pub(crate) const COUNT: usize = 4;
/// A fit that fell short of the screen's promise has not converged. It is confirmed if the promise, which is that of a linear
/// model, exceeds this share of the best log Bayes factor.
pub(crate) const STUCK: f64 = 0.6;
/// A candidate beyond the first few is confirmed only if its log Bayes factor is higher \[nats\].
pub(crate) const MIN_PROMISE: f64 = 0.0;

/// Number of further starts that fill the prior, used where the best fit so far contradicts the data.
pub(crate) const ANYWHERE: usize = 16;

/// Distances of the strength from its neutral value, in standard deviations of its prior.
const ONE_SIDED: [f64; 4] = [0.05, 0.3, 1.0, 2.0];
const TWO_SIDED: [f64; 4] = [0.5, -0.5, 1.5, -1.5];

/// Starts at the base's fit with the effect added; a switch has only the base's fit.
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
