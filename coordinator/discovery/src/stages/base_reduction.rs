//! Step 6, the base reduction: the results of the search for one effect (steps 1 to 5) are kept, and the base is fitted without each of
//! its effects.

use crate::effect_search::state::EffectSearch;
use crate::settings::{SearchSettings, Starts};
use crate::stages::branch::SearchBranch;
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;
use inference::InferenceFailure;

impl SearchState {
    /// Keeps the single effects, and fits the base without each of its effects.
    pub(super) fn after_single_effects(&mut self, branch: &SearchBranch) -> Stage {
        if let Some(failure) = branch.search.failure() {
            return Stage::Failed(failure);
        }
        self.take_numerical_noise(&branch.search);
        self.take_changes(&branch.search);
        self.hypotheses.base = branch.search.base_fit().cloned();
        self.hypotheses.ranking = branch.search.ranking().cloned().unwrap_or_default();
        self.add_combinations(branch);
        let Some(base) = self.hypotheses.base_fit() else {
            return Stage::Failed(InferenceFailure::AllImpossible {
                draws: self.evaluations,
            });
        };
        let theta = base.theta();
        let reductions = self.task.reductions.iter().enumerate();
        let branches = reductions.filter_map(|(k, reduction)| {
            let kept = reduction.parameters.iter();
            let prior = self.task.prior.subset(&reduction.parameters);
            let settings = SearchSettings {
                starts: Starts::Draws(vec![kept.map(|&i| theta[i]).collect()]),
                ..self.task.settings.clone()
            };
            let likelihood = self.task.reduced_likelihood(reduction)?;
            let search = EffectSearch::new(&prior, likelihood, &[], &settings).ok()?;
            Some(SearchBranch::without(k, Vec::new(), search))
        });
        Stage::BaseReduction(branches.collect())
    }

    /// Keeps the fits without each effect of the base, and begins the families.
    pub(super) fn after_base_reduction(&mut self, branches: &[SearchBranch]) -> Stage {
        let mut reduced = vec![None; self.task.reductions.len()];
        for branch in branches {
            if let Some(k) = branch.reduction {
                reduced[k] = branch.search.base_fit().cloned();
            }
        }
        self.hypotheses.reduced = reduced;
        self.families()
    }
}
