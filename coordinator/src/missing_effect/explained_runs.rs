//! What explanations predict for the fitted runs, and what further runs would tell.

use discovery::Conclusion;
use job::PLATE;
use record::{ExplainedRuns, NOT_IN_LIBRARY, PredictedDatum, RunInformation};
use shared::channel::Channel;

use super::models::SearchModels;

/// The predictions of every explanation that was fitted or screened.
pub(super) fn explained_runs(models: &SearchModels, conclusion: &Conclusion) -> Option<ExplainedRuns> {
    let spec = &models.base;
    let data = spec.likelihood.data();
    let wheel: Vec<usize> = (0..data.len()).filter(|&i| data[i].channel < PLATE).collect();
    let own = |values: &[f64]| wheel.iter().map(|&i| values[i]).collect::<Vec<f64>>();
    let ranked = &conclusion.ranking.effects;
    let base = ranked.iter().find(|effect| effect.candidate.is_none())?;
    let of_effects = ranked.iter().filter_map(|effect| {
        let entry = models.entry(effect.candidate?)?;
        Some((entry.effect.name.clone(), own(&effect.values)))
    });
    let law = conclusion.outside.as_ref();
    let of_law = law.map(|law| (NOT_IN_LIBRARY.to_owned(), own(&law.values)));
    Some(ExplainedRuns {
        data: wheel
            .iter()
            .filter_map(|&i| {
                Some(PredictedDatum {
                    run: spec.experiment.runs[spec.fit_runs[data[i].run]].name.clone(),
                    channel: Channel::ALL.into_iter().find(|c| c.index() == data[i].channel)?,
                })
            })
            .collect(),
        base: own(&base.values),
        effects: of_effects.chain(of_law).collect(),
    })
}

/// What each proposed run would tell by itself.
pub(super) fn information(models: &SearchModels, conclusion: &Conclusion) -> Vec<RunInformation> {
    let of_run = |&(run, nats): &(usize, f64)| {
        let condition = models.design.get(run)?;
        Some(RunInformation {
            slip: condition.slip,
            wheel_load_n: condition.wheel_load_n,
            sled_speed_m_s: condition.sled_speed_m_s,
            nats,
        })
    };
    conclusion.information.iter().filter_map(of_run).collect()
}
