//! The weight of the base with a candidate in the place of one of its effects, and the replacement that is claimed (step 13).

use crate::laplace::evidence::log_sum_exp;
use crate::probability::{DETECTED, PRIOR_OF_NONE, counted_evidence};
use crate::stages::hypotheses::{FittedReplacement, Hypotheses};
use crate::stages::noise_support::unsupported_noise;
use crate::stages::scored_fit::ScoredFit;
use crate::stages::verdict::NAMED;
use crate::stages::weighing::Weighing;
use crate::task::SearchTask;

/// A candidate in the place of an effect of the base.
#[derive(Debug, Clone, PartialEq)]
pub struct Replacement {
    /// Index of the reduction that is without the effect.
    pub reduction: usize,
    /// Index of the candidate.
    pub candidate: usize,
    /// Log evidence over that of the base.
    pub log_bayes_factor: f64,
    /// Probability among the replacements and all sets.
    pub probability: f64,
    /// Whether it is claimed: the candidate is to be added, and the effect to be dropped.
    pub is_claimed: bool,
}

/// Weighs the replacements beside the sets, by falling probability.
///
/// A replacement has the prior of the base as it is, "nothing is missing": both have as many effects.
pub(super) fn weighed(task: &SearchTask, hypotheses: &Hypotheses, weighing: &Weighing) -> Vec<Replacement> {
    let fitted = &hypotheses.replacements;
    let evidence = fitted.iter().map(|replacement| replacement.log_bayes_factor);
    let weights = evidence.map(|factor| libm::log(PRIOR_OF_NONE) + counted_evidence(factor, weighing.misfit));
    let weights: Vec<f64> = weights.collect();
    let sum = log_sum_exp(std::iter::once(weighing.log_total).chain(weights.iter().copied()));
    let weighed = fitted.iter().zip(&weights).map(|(fitted, weight)| {
        let probability = libm::exp(weight - sum);
        let is_better = fitted.log_bayes_factor / weighing.misfit > DETECTED;
        Replacement {
            reduction: fitted.reduction,
            candidate: fitted.candidate,
            log_bayes_factor: fitted.log_bayes_factor,
            probability,
            is_claimed: probability > NAMED && is_better && is_sound(task, hypotheses, weighing, fitted),
        }
    });
    let mut weighed: Vec<Replacement> = weighed.collect();
    weighed.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    weighed
}

/// Returns whether nothing speaks against a claim: no parameter is far out in its prior, the noise is known well enough, and no set without
/// the candidate predicts left-out levels better.
fn is_sound(
    task: &SearchTask,
    hypotheses: &Hypotheses,
    weighing: &Weighing,
    replacement: &FittedReplacement,
) -> bool {
    let fit = &replacement.fit;
    let position = &fit.point.position;
    let is_plausible = fit.frame.implausible(position).is_none()
        && task
            .implausible_strength(fit, &[replacement.candidate], |_| true)
            .is_none();
    let is_supported = hypotheses.base_fit().is_some_and(|base| {
        let base = ScoredFit::new(task, base);
        unsupported_noise(&task.conditions, base, replacement.scored()).is_empty()
    });
    is_plausible && is_supported && !weighing.is_disputed(replacement.candidate)
}
