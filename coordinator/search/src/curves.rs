//! The curves of a search: the predictions of the fitted measurements by each explanation, for figures.

use std::collections::BTreeMap;

use discovery::Conclusion;
use job::PLATE;
use record::{CurveDatum, EffectCurves, NOT_IN_LIBRARY};
use shared::channel::Channel;

use super::models::SearchModels;

/// Returns the curves of the base and of every explanation; `None` if the base was not fitted.
pub(super) fn curves(models: &SearchModels, conclusion: &Conclusion) -> Option<EffectCurves> {
    let spec = &models.base;
    // Readings of plates and rings do not belong to a channel of a run.
    let data = spec.likelihood.data().iter().enumerate();
    let data: Vec<(usize, CurveDatum)> = data
        .filter(|(_, datum)| datum.channel < PLATE)
        .filter_map(|(i, datum)| {
            let channel = *Channel::ALL.iter().find(|c| c.index() == datum.channel)?;
            let run = spec.experiment.runs[spec.fit_runs[datum.run]].name.clone();
            Some((i, CurveDatum { run, channel }))
        })
        .collect();
    let of_wheel =
        |values: &[f64]| -> Vec<f64> { data.iter().map(|(i, _)| six_digits(values[*i])).collect() };
    let ranking = &conclusion.ranking;
    let base = of_wheel(&ranking.effect(None)?.predicted);
    let predicted = ranking
        .effects
        .iter()
        .filter(|effect| !effect.predicted.is_empty());
    let effects =
        predicted.filter_map(|effect| Some((models.name(effect.candidate?), of_wheel(&effect.predicted))));
    let law = conclusion.predicted_by_law.as_deref();
    let law = law.map(|values| (NOT_IN_LIBRARY.to_owned(), of_wheel(values)));
    let effects: BTreeMap<String, Vec<f64>> = effects.chain(law).collect();
    let data = data.into_iter().map(|(_, datum)| datum).collect();
    Some(EffectCurves { data, base, effects })
}

/// Rounds to six significant digits, more than a figure shows.
fn six_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}
