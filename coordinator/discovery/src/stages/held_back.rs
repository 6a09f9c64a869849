//! The strength of an effect that the model has already, which its prior holds back, so that a candidate of the same class relieves it.

use crate::effect_search::projection::are_alike;
use crate::laplace::fit::LaplaceFit;
use crate::task::SearchTask;

/// A strength of the model at least this far out in its prior is held back by it \[standard deviations\]: nearer the middle, a further
/// effect that acts alike gains less than 2 nats by the relief.
const HELD_BACK: f64 = 2.0;

/// Returns the index and the normal score of the strength in the base that is held back by its prior and changes the data in the same
/// direction as the candidate; `None` without one. The candidate is then no second finding, but more of that effect.
///
/// # Arguments
/// - `base`: the fit of the model. `with`: the fit of the model with the candidate alone.
pub(super) fn held_back(task: &SearchTask, base: &LaplaceFit, with: &LaplaceFit) -> Option<(usize, f64)> {
    let (candidate, _) = with.frame.strength()?;
    let scores = task.strengths.iter().map(|&k| (k, base.point.position[k]));
    let mut far_out = scores.filter(|(_, t)| t.abs() > HELD_BACK);
    far_out.find(|(k, _)| are_alike(with, &task.likelihood, [*k, candidate]))
}
