//! The most probable explanations among those that a search has fitted so far.

use crate::laplace::evidence::log_sum_exp;
use crate::probability::{PRIOR_OF_NONE, counted_evidence};
use crate::stages::ask_tell::DiscoverySearch;
use crate::stages::hypotheses::EffectCombination;

/// Number of leaders that are told.
const LEADERS: usize = 5;

/// An explanation that was fitted, by its evidence so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Leader {
    /// Indices of its effects among the candidates; empty: nothing is missing.
    pub effects: Vec<usize>,
    /// Probability among all that is fitted so far, with half the prior on nothing missing.
    pub probability: f64,
}

impl DiscoverySearch {
    /// Returns the most probable explanations so far, the most probable first; none before the first effect is fitted.
    ///
    /// They inform whoever waits. What a search concludes weighs classes, laws and combinations as well.
    #[must_use]
    pub fn leaders(&self) -> Vec<Leader> {
        let state = &self.state;
        let library = state.task.library.len();
        let fitted = |set: &EffectCombination| {
            let weight = counted_evidence(set.fitted_log_bayes_factor(), 1.0) - set.prior_cost(library);
            (set.effects.clone(), weight)
        };
        let cost = libm::log(library.max(1) as f64);
        let single = self
            .stage
            .single_effects()
            .into_iter()
            .map(|(effect, log_bayes_factor)| {
                let weight = counted_evidence(log_bayes_factor, 1.0) - cost;
                (vec![effect], weight)
            });
        let mut weighed: Vec<(Vec<usize>, f64)> = state.hypotheses.combinations.iter().map(fitted).collect();
        if weighed.is_empty() {
            weighed.extend(single);
        }
        if weighed.is_empty() {
            return Vec::new();
        }
        let odds = libm::log((1.0 - PRIOR_OF_NONE) / PRIOR_OF_NONE);
        for (_, weight) in &mut weighed {
            *weight += odds;
        }
        weighed.push((Vec::new(), 0.0));
        let total = log_sum_exp(weighed.iter().map(|(_, weight)| *weight));
        weighed.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        let leader = |(effects, weight): (Vec<usize>, f64)| Leader {
            effects,
            probability: libm::exp(weight - total),
        };
        weighed.into_iter().take(LEADERS).map(leader).collect()
    }
}
