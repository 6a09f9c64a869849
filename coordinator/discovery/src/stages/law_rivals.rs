//! The laws that contradict a law: they change another quantity, and explain the data, too.

use crate::laplace::evidence::log_sum_exp;
use crate::stages::hypotheses::Hypotheses;
use crate::stages::weighing::Weighing;
use crate::task::SearchTask;

/// Returns the probability of the sets whose law changes another quantity than a law. Laws without effects are one set, whose evidence is
/// their mean; it counts by the share of the other quantities in that mean.
///
/// # Arguments
/// - `law`: index of the law in the task.
pub(super) fn rival_probability(
    task: &SearchTask,
    hypotheses: &Hypotheses,
    weighing: &Weighing,
    law: usize,
) -> f64 {
    let curve = &task.laws[law].curve;
    let is_rival = |other: usize| other != law && !task.laws[other].curve.shares_quantity(curve);
    let scan = hypotheses.laws.iter();
    let weights = scan.flat_map(|scan| scan.log_weights(task.laws.len(), weighing.misfit));
    let weights: Vec<(usize, f64)> = weights.collect();
    let of_rivals = weights.iter().filter(|(other, _)| is_rival(*other));
    let [of_rivals, of_all] = [
        log_sum_exp(of_rivals.map(|(_, weight)| *weight)),
        log_sum_exp(weights.iter().map(|(_, weight)| *weight)),
    ];
    let share = if weights.is_empty() {
        0.0
    } else {
        libm::exp(of_rivals - of_all)
    };
    let sets = weighing.sets.iter().map(|set| match &set.effects {
        None => set.probability * share,
        Some(effects) => {
            let mut laws = effects.iter().filter_map(|k| task.law_of(*k));
            if laws.any(is_rival) { set.probability } else { 0.0 }
        }
    });
    sets.sum()
}
