//! The state of a discovery: its task, the results of the stages so far, and their cost.

use std::collections::BTreeMap;

use crate::effect_search::change::CandidateChange;
use crate::effect_search::depth::Depth;
use crate::effect_search::state::EffectSearch;
use crate::laplace::fit::FittedModel;
use crate::probability::DETECTED;
use crate::settings::Smoothness;
use crate::stages::branch::SearchBranch;
use crate::stages::cross_validation::{ComparedModel, CrossValidation, ModelKey, RefittedModel};
use crate::stages::hypotheses::{EffectCombination, Hypotheses};
use crate::task::SearchTask;

/// The task, the results so far, and their cost.
#[derive(Debug, Clone)]
pub(super) struct SearchState {
    pub(super) task: SearchTask,
    pub(super) hypotheses: Hypotheses,
    pub(super) evaluations: usize,
    /// Numerical noise sd of each channel by its index, in its unit; empty where it is negligible.
    pub(super) numerical_noise_sds: Vec<f64>,
    /// What each candidate of the library changes of the base's predictions.
    changes: Vec<Option<CandidateChange>>,
    /// The models that were fitted without each level.
    refitted: BTreeMap<ModelKey, RefittedModel>,
}

impl SearchState {
    pub(super) fn new(task: SearchTask) -> Self {
        SearchState {
            hypotheses: Hypotheses::new(task.candidates()),
            task,
            evaluations: 0,
            numerical_noise_sds: Vec::new(),
            changes: Vec::new(),
            refitted: BTreeMap::new(),
        }
    }

    /// Returns the cross-validation of some models, which reuses earlier refits.
    pub(super) fn validated(&self, models: &[ComparedModel]) -> CrossValidation {
        CrossValidation::new(&self.task.likelihood, &self.task.levels, models, &self.refitted)
    }

    /// Keeps the refits of a completed cross-validation.
    pub(super) fn keep_refits(&mut self, validation: &CrossValidation) {
        self.refitted.extend(validation.refitted());
    }

    /// Adds the numerical noise that the search for one effect has measured to the noise of measured and proposed data, and keeps
    /// the smoothness of the model.
    pub(super) fn take_numerical_noise(&mut self, search: &EffectSearch) {
        let task = &mut self.task;
        task.settings.has_numerical_noise = false;
        task.settings.smoothness = search.smoothness();
        task.likelihood.clone_from(&search.likelihood);
        self.numerical_noise_sds.clone_from(&search.numerical_noise_sds);
        let proposed = task.proposed.channels.iter().zip(&mut task.proposed.noise_sds);
        for (channel, sd) in proposed {
            let scatter = self.numerical_noise_sds.get(*channel).copied().unwrap_or(0.0);
            *sd = (*sd * *sd + scatter * scatter).sqrt();
        }
    }

    /// Keeps what the candidates change: it selects those that are screened beyond a combination.
    pub(super) fn take_changes(&mut self, search: &EffectSearch) {
        self.changes = search.changes();
    }

    /// Returns whether combinations of effects that explain little alone are searched: the best explanation contradicts the data,
    /// and the model's evaluations are cheap.
    pub(super) fn searches_widely(&self) -> bool {
        let is_smooth = self.task.settings.smoothness == Smoothness::Smooth;
        is_smooth && self.task.max_effects > 1 && self.hypotheses.is_incomplete(&self.task.likelihood)
    }

    /// Returns the fit of the base, of a set of effects, or of a law alone.
    pub(super) fn fitted(&self, effects: &[usize]) -> Option<FittedModel> {
        let base = self.hypotheses.base.as_ref()?;
        if effects.is_empty() {
            return Some(base.clone());
        }
        if let Some(combination) = self.hypotheses.combination(effects) {
            return Some(FittedModel {
                fit: combination.fit.clone(),
                log_evidence: base.log_evidence + combination.fitted_log_bayes_factor(),
            });
        }
        let mut laws = self.hypotheses.laws.as_ref()?.laws.iter();
        let law = laws.find(|law| effects == [law.candidate])?;
        Some(FittedModel {
            fit: law.fit.clone(),
            log_evidence: base.log_evidence + law.log_bayes_factor,
        })
    }

    /// Returns a search of some candidates beyond a combination; `None` without candidates.
    pub(super) fn branch(
        &self,
        beyond: Vec<usize>,
        candidates: Vec<usize>,
        depth: &'static Depth,
    ) -> Option<SearchBranch> {
        let chosen: Vec<_> = candidates
            .iter()
            .map(|&k| self.hypotheses.candidates[k].clone())
            .collect();
        let base = self.fitted(&beyond)?;
        if chosen.is_empty() {
            return None;
        }
        let change = |k: &usize| self.changes.get(*k).cloned().flatten();
        let changes: Vec<_> = candidates.iter().map(change).collect();
        let likelihood = self.task.likelihood.clone();
        let candidates_with_changes = (chosen.as_slice(), changes.as_slice());
        let seed = self.task.settings.seed;
        let search = EffectSearch::beyond(base, likelihood, candidates_with_changes, depth, seed);
        Some(SearchBranch::new(beyond, candidates, search))
    }

    /// Returns the effects of the library that can join a set: they act together with each of its effects, and turn no setting.
    pub(super) fn further_effects(&self, effects: &[usize]) -> Vec<usize> {
        let library = &self.task.library;
        let combines = |k: usize| {
            let mut of_library = effects.iter().filter(|effect| !self.task.is_law(**effect));
            of_library.all(|effect| *effect != k && library[k].combines_with(&library[*effect]))
        };
        let further = (0..library.len()).filter(|k| combines(*k) && !library[*k].is_switch());
        further.collect()
    }

    /// Returns whether a law is among the members of a set.
    pub(super) fn has_law(&self, effects: &[usize]) -> bool {
        effects.iter().any(|k| self.task.is_law(*k))
    }

    /// Returns a combination as a model for the cross-validation.
    pub(super) fn compared<'a>(&self, set: &'a EffectCombination) -> ComparedModel<'a> {
        (set.effects.clone(), self.last_parameters(&set.effects), &set.fit)
    }

    /// Returns the number of parameters of the last member of a set.
    pub(super) fn last_parameters(&self, effects: &[usize]) -> usize {
        let last = effects.last();
        last.map_or(0, |&k| self.hypotheses.candidates[k].parameters.len())
    }

    /// Keeps the combinations that branches without candidates have fitted.
    pub(super) fn add_fitted(&mut self, branches: &[SearchBranch]) {
        let base = self.hypotheses.base_evidence();
        for branch in branches {
            if let Some(fitted) = branch.search.base_fit() {
                self.hypotheses.add(EffectCombination {
                    effects: branch.effects.clone(),
                    log_bayes_factor: fitted.log_evidence - base - branch.choice,
                    choice: branch.choice,
                    fit: fitted.fit.clone(),
                });
            }
        }
    }

    /// Keeps the results of a branch: all single effects, and the combinations with a detectable gain.
    pub(super) fn add_combinations(&mut self, branch: &SearchBranch) {
        let base = self.hypotheses.base_evidence();
        let extended = branch
            .search
            .base_fit()
            .map_or(0.0, |model| model.log_evidence - base);
        for (candidate, ranked) in branch.ranked() {
            let improves = branch.effects.is_empty() || ranked.log_bayes_factor > DETECTED;
            let fit = ranked.candidate.and_then(|k| branch.search.fit_of(k));
            if let (true, Some(fit)) = (improves, fit) {
                let mut effects = branch.effects.clone();
                effects.push(candidate);
                self.hypotheses.add(EffectCombination {
                    effects,
                    log_bayes_factor: extended + ranked.log_bayes_factor - branch.choice,
                    choice: branch.choice,
                    fit: fit.clone(),
                });
            }
        }
    }

    /// Returns each effect of a combination with its coordinates at the combination's fit.
    pub(super) fn coordinates<'a>(
        &'a self,
        combination: &'a EffectCombination,
    ) -> impl Iterator<Item = (usize, &'a [f64])> {
        let mut rest = &combination.fit.point.position[self.task.prior.dimension()..];
        combination.effects.iter().map(move |&k| {
            let (coordinates, following) = rest.split_at(self.hypotheses.candidates[k].parameters.len());
            rest = following;
            (k, coordinates)
        })
    }
}
