//! The stages that search effects of the library.

use crate::chi_square::FURTHER_EFFECT;
use crate::effect_search::depth::{GLANCE, QUICK};
use crate::effect_search::state::EffectSearch;
use crate::laplace::fit::FittedModel;
use crate::probability::DETECTED;
use crate::search::branch::SearchBranch;
use crate::search::hypotheses::{EffectCombination, candidate_set};
use crate::search::stage::Stage;
use crate::search::state::SearchState;
use crate::settings::{SearchSettings, Smoothness, Starts};
use inference::InferenceFailure;

/// Beam width: number of combinations beyond which a further effect is searched.
const BEAM: usize = 3;
/// Number of single effects beyond which a further effect is searched if the best explanation contradicts the data: two effects
/// that explain much together may explain little alone.
const WIDE_BEAM: usize = 6;

impl SearchState {
    pub(super) fn after_single_effects(&mut self, branch: &SearchBranch) -> Stage {
        if let Some(failure) = branch.search.failure() {
            return Stage::Failed(failure);
        }
        self.take_numerical_noise(&branch.search);
        self.hypotheses.base = branch.search.base_fit().cloned();
        self.hypotheses.ranking = branch.search.ranking().cloned().unwrap_or_default();
        self.add_combinations(branch, 0.0);
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
            let search = EffectSearch::new(&prior, self.task.likelihood.clone(), &[], &settings).ok()?;
            Some(SearchBranch::without(k, search))
        });
        Stage::BaseReduction(branches.collect())
    }

    pub(super) fn after_base_reduction(&mut self, branches: &[SearchBranch]) -> Stage {
        let base = self.hypotheses.base_evidence();
        let mut gains = vec![None; self.task.reductions.len()];
        for branch in branches {
            if let (Some(k), Some(fitted)) = (branch.reduction, branch.search.base_fit()) {
                gains[k] = Some(base - fitted.log_evidence);
            }
        }
        self.hypotheses.gains = gains;
        self.families()
    }

    /// Searches one more effect beyond the best combinations of a size, unless the library fits already.
    pub(super) fn beam_search(&mut self, size: usize) -> Stage {
        let hypotheses = &self.hypotheses;
        let is_wide = size == 1 && self.searches_widely();
        let combinations = hypotheses.combinations.iter();
        let eligible = combinations
            .filter(|c| c.effects.len() == size && (c.log_bayes_factor > DETECTED || is_wide))
            // A model with another setting may lack effects that the others have.
            .filter(|c| !c.effects.iter().any(|k| self.task.library[*k].is_switch()));
        let mut best: Vec<&EffectCombination> = eligible.collect();
        let width = if is_wide { WIDE_BEAM } else { BEAM };
        // Keep each family's best set in the beam even if it ranks low: an effect not added yet may make it the winner.
        let is_of_family =
            |c: &&EffectCombination| hypotheses.family_sets.contains(&candidate_set(&c.effects));
        let family = best.iter().position(is_of_family).filter(|place| *place >= width);
        let family = family.map(|place| best[place]);
        best.truncate(width);
        best.extend(family);
        let leaves_misfit = hypotheses
            .chi_square(&self.task.likelihood)
            .is_none_or(|chi| chi.p() < FURTHER_EFFECT);
        if size >= self.task.max_effects || best.is_empty() || !leaves_misfit {
            return self.backward_elimination();
        }
        let branches = best.into_iter().enumerate().map(|(rank, combination)| {
            let library = &self.task.library;
            let combines = |k: usize| {
                let mut effects = combination.effects.iter();
                effects.all(|effect| *effect != k && library[k].combines_with(&library[*effect]))
            };
            let further: Vec<usize> = (0..library.len())
                .filter(|k| combines(*k) && !library[*k].is_switch())
                .collect();
            let candidates: Vec<_> = further.iter().map(|&k| self.task.library[k].clone()).collect();
            let base = FittedModel {
                fit: combination.fit.clone(),
                log_evidence: hypotheses.base_evidence() + combination.log_bayes_factor,
            };
            let likelihood = self.task.likelihood.clone();
            let seed = self.task.settings.seed;
            let depth = if rank < BEAM { &QUICK } else { &GLANCE };
            let search = EffectSearch::beyond(base, likelihood, &candidates, depth, seed);
            SearchBranch::new(combination.effects.clone(), further, search)
        });
        Stage::BeamSearch(size, branches.collect())
    }

    pub(super) fn after_beam_search(&mut self, size: usize, branches: &[SearchBranch]) -> Stage {
        let base = self.hypotheses.base_evidence();
        for branch in branches {
            let extended = branch
                .search
                .base_fit()
                .map_or(0.0, |model| model.log_evidence - base);
            self.add_combinations(branch, extended);
        }
        let has_grown = self
            .hypotheses
            .best()
            .is_some_and(|best| best.effects.len() > size);
        if has_grown {
            self.beam_search(size + 1)
        } else {
            self.backward_elimination()
        }
    }

    /// Fits the best combination without each of its effects, from its mode: a later effect may have made an earlier one redundant.
    fn backward_elimination(&mut self) -> Stage {
        let Some(best) = self.hypotheses.best().filter(|best| best.effects.len() > 1) else {
            return self.exchanges(0);
        };
        let branches = best.effects.iter().map(|&dropped| {
            let mut frame = self.task.frame();
            let (base_position, mut rest) = best.fit.point.position.split_at(self.task.prior.dimension());
            let mut start = base_position.to_vec();
            let mut effects = Vec::new();
            for &k in &best.effects {
                let candidate = &self.hypotheses.candidates[k];
                let (coordinates, following) = rest.split_at(candidate.parameters.len());
                rest = following;
                if k != dropped {
                    frame = frame.with(candidate);
                    start.extend_from_slice(coordinates);
                    effects.push(k);
                }
            }
            let seed = self.task.settings.seed;
            let search = EffectSearch::refit(frame, vec![start], self.task.likelihood.clone(), seed);
            SearchBranch::new(effects, Vec::new(), search)
        });
        Stage::BackwardElimination(branches.collect())
    }

    pub(super) fn after_backward_elimination(&mut self, branches: &[SearchBranch]) -> Stage {
        self.add_fitted(branches);
        self.exchanges(0)
    }

    /// Whether combinations of effects that explain little alone are searched: the best explanation contradicts the data, and the
    /// model's evaluations are cheap.
    pub(super) fn searches_widely(&self) -> bool {
        let is_smooth = self.task.settings.smoothness == Smoothness::Smooth;
        is_smooth && self.task.max_effects > 1 && self.hypotheses.is_incomplete(&self.task.likelihood)
    }

    /// Keeps the combinations that branches without candidates have fitted.
    pub(super) fn add_fitted(&mut self, branches: &[SearchBranch]) {
        let base = self.hypotheses.base_evidence();
        for branch in branches {
            if let Some(fitted) = branch.search.base_fit() {
                self.hypotheses.add(EffectCombination {
                    effects: branch.effects.clone(),
                    log_bayes_factor: fitted.log_evidence - base,
                    fit: fitted.fit.clone(),
                });
            }
        }
    }

    /// Keeps the results of a branch: all single effects, and the combinations with a detectable gain.
    fn add_combinations(&mut self, branch: &SearchBranch, extended: f64) {
        for (candidate, ranked) in branch.ranked() {
            let improves = branch.effects.is_empty() || ranked.log_bayes_factor > DETECTED;
            let fit = ranked.candidate.and_then(|k| branch.search.fit_of(k));
            if let (true, Some(fit)) = (improves, fit) {
                let mut effects = branch.effects.clone();
                effects.push(candidate);
                self.hypotheses.add(EffectCombination {
                    effects,
                    log_bayes_factor: extended + ranked.log_bayes_factor,
                    fit: fit.clone(),
                });
            }
        }
    }
}
