//! Step 8, the backward elimination: the best combination is fitted without each of its effects.

use crate::effect_search::state::EffectSearch;
use crate::stages::branch::SearchBranch;
use crate::stages::hypotheses::EffectCombination;
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;

impl SearchState {
    /// Fits the best combination without each of its effects, from its mode: a later effect may have made an earlier one redundant.
    pub(super) fn backward_elimination(&mut self) -> Stage {
        let Some(best) = self.hypotheses.best().filter(|best| best.effects.len() > 1) else {
            return self.exchanges(0);
        };
        Stage::BackwardElimination(self.without_each(best))
    }

    /// Returns fits of a set without each of its members, from its mode.
    pub(super) fn without_each(&self, set: &EffectCombination) -> Vec<SearchBranch> {
        let branches = set.effects.iter().map(|&dropped| {
            let mut frame = self.task.frame();
            let mut start = set.fit.point.position[..self.task.prior.dimension()].to_vec();
            let mut effects = Vec::new();
            for (k, coordinates) in self.coordinates(set) {
                if k != dropped {
                    frame = frame.with(&self.hypotheses.candidates[k]);
                    start.extend_from_slice(coordinates);
                    effects.push(k);
                }
            }
            let seed = self.task.settings.seed;
            let search = EffectSearch::refit(frame, vec![start], self.task.likelihood.clone(), seed);
            let choice = if self.has_law(&effects) { set.choice } else { 0.0 };
            SearchBranch::new(effects, Vec::new(), search).with_choice(choice)
        });
        branches.collect()
    }

    /// Keeps the reduced combinations, and begins the exchanges.
    pub(super) fn after_backward_elimination(&mut self, branches: &[SearchBranch]) -> Stage {
        self.add_fitted(branches);
        self.exchanges(0)
    }
}
