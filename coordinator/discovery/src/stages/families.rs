//! Step 7, the families: effects that change one quantity, each in other conditions, are fitted together.

use crate::effect_search::base::starts;
use crate::effect_search::state::EffectSearch;
use crate::stages::branch::SearchBranch;
use crate::stages::hypotheses::candidate_set;
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;

/// Families with more members are not tried: their subsets are too many.
const MAX_MEMBERS: usize = 4;
/// Distances of all strengths from their neutral values at the starts about the base's fit, in standard deviations of their priors.
const START_DISTANCES: [f64; 2] = [0.3, 1.0];
/// Number of further starts, which fill the prior.
const PRIOR_STARTS: usize = 6;

impl SearchState {
    /// Fits every subset of a family. Each member alone may explain little, such as a sinkage that grows with slip in drive, in
    /// skid and sideways; a search that adds one effect at a time may then choose others.
    pub(super) fn families(&mut self) -> Stage {
        if !self.searches_widely() {
            return self.beam_search(1);
        }
        let branches = self
            .subsets()
            .into_iter()
            .filter_map(|subset| self.fit_together(subset));
        Stage::Families(branches.collect())
    }

    /// Keeps the fitted sets, and begins the beam search.
    pub(super) fn after_families(&mut self, branches: &[SearchBranch]) -> Stage {
        self.add_fitted(branches);
        let fitted = branches.iter().map(|branch| candidate_set(&branch.effects));
        self.hypotheses.family_sets = fitted.collect();
        self.beam_search(1)
    }

    /// Returns the subsets of all families, of two effects and more.
    fn subsets(&self) -> Vec<Vec<usize>> {
        let library = &self.task.library;
        let mut names: Vec<&String> = library
            .iter()
            .filter_map(|candidate| candidate.family.as_ref())
            .collect();
        names.sort_unstable();
        names.dedup();
        let mut subsets = Vec::new();
        for name in names {
            let is_member = |k: &usize| library[*k].family.as_ref() == Some(name);
            let members: Vec<usize> = (0..library.len()).filter(is_member).collect();
            if members.len() > MAX_MEMBERS {
                continue;
            }
            for chosen in 0_u32..1 << members.len() {
                let chosen_members = members.iter().enumerate();
                let effects: Vec<usize> = chosen_members
                    .filter(|(i, _)| chosen >> i & 1 == 1)
                    .map(|(_, k)| *k)
                    .collect();
                let combines = |k: &usize| {
                    effects
                        .iter()
                        .all(|l| k == l || library[*k].combines_with(&library[*l]))
                };
                // A set is fitted only if at least one member was ranked as a single effect.
                let is_ranked = effects
                    .iter()
                    .any(|k| self.hypotheses.ranking.effect(Some(*k)).is_some());
                let is_possible = is_ranked && effects.iter().all(combines);
                if (2..=self.task.max_effects).contains(&effects.len()) && is_possible {
                    subsets.push(effects);
                }
            }
        }
        subsets
    }

    /// Fits a set of effects together with the base.
    fn fit_together(&self, effects: Vec<usize>) -> Option<SearchBranch> {
        let mut frame = self.task.frame();
        let base = &self.hypotheses.base_fit()?.point.position;
        let mut at_base = vec![base.clone(); START_DISTANCES.len()];
        for &k in &effects {
            frame = frame.with(&self.task.library[k]);
            for (position, distance) in at_base.iter_mut().zip(START_DISTANCES) {
                position.resize(frame.dimension(), 0.0);
                for &(strength, neutral) in &frame.strengths {
                    position[strength] = neutral + distance;
                }
            }
        }
        at_base.extend(starts(&frame, PRIOR_STARTS));
        let likelihood = self.task.likelihood.clone();
        let search = EffectSearch::refit(frame, at_base, likelihood, self.task.settings.seed);
        Some(SearchBranch::new(effects, Vec::new(), search))
    }
}
