//! Fit the most probable extensions from several starts, so that none hides behind a poor one.

use super::coordinate::Frame;
use super::descent::{Descent, Step};

/// How many extensions are confirmed.
pub(super) const COUNT: usize = 4;

/// As thorough as the base's fit.
pub(super) const PLAN: [Step; 1] = [Step::Rounds { most: 4, trials: 12 }];

/// Distances of the strength from its neutral value, in standard deviations of its prior.
const STRENGTHS: [f64; 3] = [0.3, 1.0, 2.0];

/// Where the fits begin: at the base's fit, the effect weak, usual and strong, and of either sign where it may be.
pub(super) fn starts(frame: &Frame, base: &Descent) -> Vec<Vec<f64>> {
    let signs: &[f64] = if frame.is_one_sided() {
        &[1.0]
    } else {
        &[1.0, -1.0]
    };
    let count = STRENGTHS.len() * signs.len();
    // The shapes go round their usual values, so that each start has another.
    let start = |n: usize| {
        let mut position = base.point.position.clone();
        position.resize(frame.dimension(), [0.0, 1.0, -1.0][n % 3]);
        if let Some(k) = frame.strength {
            position[k] = frame.neutral + signs[n % signs.len()] * STRENGTHS[n / signs.len()];
        }
        position
    };
    (0..count).map(start).collect()
}

/// The same fit, gone on with.
pub(super) fn descent(fitted: &Descent) -> Descent {
    Descent::new(
        fitted.frame.clone(),
        fitted.point.clone(),
        fitted.columns.clone(),
        &PLAN,
    )
}
