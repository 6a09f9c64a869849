//! A branch of a stage: a search for one effect, or a fit, with its candidates named by their indices in the task.

use std::ops::Range;

use crate::effect_search::ranking::RankedEffect;
use crate::effect_search::state::EffectSearch;
use crate::laplace::fit::LaplaceFit;
use crate::stages::query::{QueriedModel, Query};

/// A search for one more effect beyond a combination, a fit of a combination, or a fit of the base without one of its effects.
#[derive(Debug, Clone)]
pub(super) struct SearchBranch {
    /// The effects of its model beyond the base.
    pub(super) effects: Vec<usize>,
    /// The effect of the base that is left out.
    pub(super) reduction: Option<usize>,
    /// The index in the task of each candidate of this search.
    candidates: Vec<usize>,
    pub(super) search: EffectSearch,
    /// Cost of the choice of the law among its effects \[nats\]; 0 without a law.
    pub(super) choice: f64,
}

impl SearchBranch {
    pub(super) fn new(effects: Vec<usize>, candidates: Vec<usize>, search: EffectSearch) -> Self {
        Self {
            effects,
            reduction: None,
            candidates,
            search,
            choice: 0.0,
        }
    }

    /// This branch, with the cost of the choice of a law among its effects.
    pub(super) fn with_choice(self, choice: f64) -> Self {
        Self { choice, ..self }
    }

    /// Returns the fit of the base without one of its effects, and with others.
    pub(super) fn without(reduction: usize, effects: Vec<usize>, search: EffectSearch) -> Self {
        Self {
            reduction: Some(reduction),
            ..Self::new(effects, Vec::new(), search)
        }
    }

    /// Returns the queries of the current round; none once the search is done.
    pub(super) fn queries(&self) -> Vec<Query> {
        if self.search.ranking().is_some() || self.search.failure().is_some() {
            return Vec::new();
        }
        let queries = self.search.pending().map(|request| {
            let mut effects = self.effects.clone();
            effects.extend(request.candidate.map(|k| self.candidates[k]));
            Query {
                model: match self.reduction {
                    None => QueriedModel::With(effects),
                    Some(reduction) => QueriedModel::Without(reduction, effects),
                },
                is_proposed: false,
                is_low_fidelity: request.is_low_fidelity,
                theta: request.theta,
            }
        });
        queries.collect()
    }

    /// Returns the candidates that have evidence so far, by their indices in the task, with their log Bayes factors.
    pub(super) fn fitted(&self) -> Vec<(usize, f64)> {
        let known = self.candidates.iter().enumerate();
        known
            .filter_map(|(k, &candidate)| Some((candidate, self.search.log_bayes_factor_of(k)?)))
            .collect()
    }

    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        for (index, values) in answers.into_iter().enumerate() {
            // The values were checked when they arrived, and each index is told once.
            let result = self.search.tell(index, values.as_deref());
            debug_assert!(result.is_ok(), "{result:?}");
        }
    }

    /// Returns the range of a candidate's parameters among those of its fit, whose first are those of the model of this branch.
    pub(super) fn added_parameters(&self, fit: &LaplaceFit) -> Range<usize> {
        let base = self.search.base_fit();
        base.map_or(0, |base| base.fit.frame.dimension())..fit.frame.dimension()
    }

    /// Returns the candidates by falling Bayes factor, each with its index in the task.
    pub(super) fn ranked(&self) -> Vec<(usize, &RankedEffect)> {
        let ranked = self
            .search
            .ranking()
            .into_iter()
            .flat_map(|ranking| ranking.ranked());
        ranked
            .filter_map(|effect| Some((self.candidates[effect.candidate?], effect)))
            .collect()
    }
}
