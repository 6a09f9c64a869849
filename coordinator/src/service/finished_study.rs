//! A finished calibration, and its study, loaded from the store.

use std::sync::OnceLock;

use shared::api::CalibrationState;
use shared::outcome::Observables;

use super::error::ServiceError;
use super::handle::Service;
use super::stored_calibration::ParsedExperiments;
use super::study_members::study_members;
use super::study_step::next_step_from;
use crate::study::{Lineage, most_probable};
use inference::Particle;
use job::{AlgorithmSettings, Spec};
use record::CalibrationRow;
use result::{
    DiscoveryRound, FinishedCalibration, Outcome, SampledPosterior, Study, first_population, likeliest,
};
use store::Reader;

/// Refuses a calibration that has no result: one that is not finished, or a search.
pub(super) fn check_finished(row: &CalibrationRow) -> Result<(), ServiceError> {
    match (row.state, row.membership.is_search()) {
        (CalibrationState::Finished, false) => Ok(()),
        (CalibrationState::Finished, true) => Err(ServiceError::Search(row.id)),
        _ => Err(ServiceError::not_finished(row)),
    }
}

/// Loads a finished calibration.
///
/// # Errors
/// [`ServiceError::Control`] where it is not finished; [`ServiceError::Effects`] where this program has other
/// effects; others where the store cannot be read.
pub(super) async fn finished_calibration(
    reader: &Reader,
    row: &CalibrationRow,
) -> Result<FinishedCalibration, ServiceError> {
    finished_with(reader, row, &mut ParsedExperiments::default()).await
}

/// Loads a finished calibration of a study whose experiments were parsed before.
async fn finished_with(
    reader: &Reader,
    row: &CalibrationRow,
    experiments: &mut ParsedExperiments,
) -> Result<FinishedCalibration, ServiceError> {
    check_finished(row)?;
    let mut spec = experiments.spec_of(reader, row).await?;
    let emulator = reader.emulator(row.id).await?;
    if emulator.is_none() {
        spec.algorithm = spec.algorithm.without_emulator();
    }
    // Parameters and texts would be shown with which the result was not computed.
    if let Some(pinned) = &row.model_version {
        spec.check_effects(pinned)?;
    }
    let is_sample = matches!(spec.algorithm, AlgorithmSettings::Sample(_));
    let (estimate, prior_draws) = match is_sample {
        true => (None, reader.prior_draws(row.id, spec.algorithm.width()).await?),
        false => (reader.estimate(row.id).await?, Vec::new()),
    };
    let mut populations = reader.populations(row.id).await?;
    // The draws of a normal approximation have no stage.
    let posterior = match populations.pop() {
        Some(last) => last,
        None => reader.samples(row.id, None).await?,
    };
    if is_sample {
        populations.insert(0, first_population(&spec, &prior_draws));
    }
    let at_likeliest = reader.likeliest(row.id).await?;
    let likeliest_values = likeliest_values(reader, row, &spec, &posterior, at_likeliest.as_ref()).await?;
    let histories = at_likeliest.map(|observables| observables.histories);
    let sampled = SampledPosterior {
        draws: posterior,
        populations,
        prior_draws,
        stages: reader.stages(row.id).await?,
    };
    let outcome = Outcome::new(estimate, sampled);
    Ok(FinishedCalibration {
        spec,
        outcome,
        emulator,
        experiment: row.name.clone(),
        likeliest_values,
        predictions: reader.predictions(row.id).await?,
        simulated_histories: histories.filter(|histories| !histories.is_empty()),
        rejections: reader.rejections(row.id).await?,
        faults: reader.faults(row.id).await?,
        given_up: reader.given_up(row.id).await?,
        disputes: reader.disputes(row.id).await?,
        verified: reader.verified(row.id).await?,
        repeats: reader.repeats(row.id).await?,
        interpolations: Default::default(),
        comparison: Default::default(),
        row: row.clone(),
    })
}

/// Returns the predicted values at the likeliest draw: from its observables, or as they were stored for the sampler.
async fn likeliest_values(
    reader: &Reader,
    row: &CalibrationRow,
    spec: &Spec,
    posterior: &[Particle],
    at_likeliest: Option<&Observables>,
) -> Result<Option<Vec<f64>>, ServiceError> {
    let Some(sample) = likeliest(posterior) else {
        return Ok(None);
    };
    // Programs of version scm-5 and earlier left out readings and derivatives where they simulated histories.
    let whole = at_likeliest.filter(|observables| {
        let histories = spec.fit_variant.with_histories();
        observables.covers(histories.as_ref().unwrap_or(&spec.fit_variant))
    });
    match whole {
        Some(observables) => Ok(Some(spec.predicted_values(observables))),
        None => Ok(reader.fitted_values(row.id, &sample.theta).await?),
    }
}

/// Loads the finished members of a calibration's study, out of the given members. A member that joins meanwhile is left out.
///
/// # Errors
/// [`finished_calibration`] states them for the given calibration, where nothing is finished.
pub(super) async fn finished_study(
    reader: &Reader,
    row: &CalibrationRow,
    rows: &[CalibrationRow],
) -> Result<Study, ServiceError> {
    let unfinished = rows.iter().find(|r| r.state != CalibrationState::Finished);
    let finished = rows.iter().filter(|r| r.state == CalibrationState::Finished);
    let calibrations: Vec<_> = finished.filter(|row| !row.membership.is_search()).collect();
    let lineage = Lineage::new(rows);
    let models = lineage.compared().len();
    let compared =
        |row: &CalibrationRow| models > 1 && lineage.compared().iter().any(|other| other.id == row.id);
    let of_models: Vec<_> = calibrations.iter().filter(|row| compared(row)).collect();
    let best = most_probable(of_models.iter().map(|row| row.log_evidence)).map(|i| of_models[i]);
    // Without any, the error of the requested calibration states why there is no result.
    let lead = best.or(calibrations.first()).copied().unwrap_or(row);
    let mut experiments = ParsedExperiments::default();
    let lead = finished_with(reader, lead, &mut experiments).await?;
    let (mut other_models, mut point_estimates, mut extensions) = (Vec::new(), Vec::new(), Vec::new());
    for row in calibrations.into_iter().filter(|row| row.id != lead.row.id) {
        if compared(row) {
            other_models.push(finished_with(reader, row, &mut experiments).await?);
            continue;
        }
        let group = match lineage.model_of(row.id) == lineage.model_of(lead.row.id) {
            true => &mut point_estimates,
            false => &mut extensions,
        };
        group.push(finished_with(reader, row, &mut experiments).await?);
    }
    let (_, withdrawn) = reader.members_and_withdrawn(row.study).await?;
    let state = match unfinished {
        Some(row) => row.state,
        // The next step of a study is unfinished work, although it has not begun.
        None if next_step_from(reader, rows, &withdrawn).await?.is_some() => CalibrationState::Running,
        None => CalibrationState::Finished,
    };
    Ok(Study {
        state,
        models,
        lead,
        other_models,
        point_estimates,
        extensions,
        rounds: search_rounds(reader, rows).await?,
        members: study_members(reader, rows).await?,
        combined: OnceLock::new(),
    })
}

impl Service {
    /// Reads the finished searches of a study, without those that were taken out of it.
    pub async fn search_rounds(&self, study: i64) -> Result<Vec<DiscoveryRound>, ServiceError> {
        let reader = self.store().reader();
        let (members, _) = reader.members_and_withdrawn(study).await?;
        search_rounds(&reader, &members).await
    }
}

/// Reads the finished searches among the members of a study.
async fn search_rounds(
    reader: &Reader,
    rows: &[CalibrationRow],
) -> Result<Vec<DiscoveryRound>, ServiceError> {
    let finished = rows.iter().filter(|row| row.state == CalibrationState::Finished);
    let mut rounds = Vec::new();
    for search in finished.filter(|row| row.membership.is_search()) {
        let record = reader.discovery(search.id).await?;
        if let (Some(calibration), Some(record)) = (search.membership.parent, record) {
            rounds.push(DiscoveryRound { calibration, record });
        }
    }
    Ok(rounds)
}
