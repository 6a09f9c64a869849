//! The state of a discovery: its task, the results of the stages so far, and their cost.

use std::collections::BTreeMap;

use crate::effect_search::state::EffectSearch;
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

    /// Returns whether combinations of effects that explain little alone are searched: the best explanation contradicts the data,
    /// and the model's evaluations are cheap.
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
