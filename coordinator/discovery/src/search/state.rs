//! The task and the results of a search.

use std::collections::BTreeMap;

use crate::effect_search::state::EffectSearch;
use crate::search::cross_validation::{ComparedModel, CrossValidation, ModelKey, RefittedModel};
use crate::search::hypotheses::Hypotheses;
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

    /// The cross-validation of some models, which reuses earlier refits.
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
}
