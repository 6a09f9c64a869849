//! The task and the results of a search.

use crate::effect_search::state::EffectSearch;
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
}

impl SearchState {
    /// Counts the numerical noise that the search for one effect has found as noise of all data, measured or proposed, and keeps whether
    /// the model is rough.
    pub(super) fn take_numerical_noise(&mut self, search: &EffectSearch) {
        let task = &mut self.task;
        task.settings.has_numerical_noise = false;
        task.settings.roughness = search.roughness();
        task.likelihood.clone_from(&search.likelihood);
        self.numerical_noise_sds.clone_from(&search.numerical_noise_sds);
        let proposed = task.proposed.channels.iter().zip(&mut task.proposed.noise_sds);
        for (channel, sd) in proposed {
            let scatter = self.numerical_noise_sds.get(*channel).copied().unwrap_or(0.0);
            *sd = (*sd * *sd + scatter * scatter).sqrt();
        }
    }
}
