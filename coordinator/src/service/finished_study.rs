//! A finished calibration, and its study, loaded from the store.

use std::sync::OnceLock;

use shared::api::CalibrationState;

use super::error::ServiceError;
use super::stored_calibration::ParsedExperiments;
use super::study_members::study_members;
use super::study_step::next_step_from;
use crate::study::{Lineage, most_probable};
use job::AlgorithmSettings;
use record::CalibrationRow;
use result::{
    DiscoveryRound, FinishedCalibration, Outcome, SampledPosterior, Study, first_population, likeliest,
};
use store::Reader;

/// Loads a finished calibration.
///
/// # Errors
/// [`ServiceError::Control`] where it is not finished; [`ServiceError::Effects`] where this program has other
/// effects; others where the store cannot be read.
pub async fn finished_calibration(
    reader: &Reader,
    row: &CalibrationRow,
) -> Result<FinishedCalibration, ServiceError> {
    finished_with(reader, row, &mut ParsedExperiments::default()).await
}

/// A finished calibration of a study whose experiments were parsed before.
async fn finished_with(
    reader: &Reader,
    row: &CalibrationRow,
    experiments: &mut ParsedExperiments,
) -> Result<FinishedCalibration, ServiceError> {
    if row.state != CalibrationState::Finished {
        return Err(ServiceError::not_finished(row));
    }
    if row.membership.is_search() {
        return Err(ServiceError::Search(row.id));
    }
    let spec = experiments.spec_of(reader, row).await?;
    // Parameters and texts would be shown that the result was not computed with.
    if let Some(pinned) = &row.model_version {
        spec.check_effects(pinned)?;
    }
    let estimate = match spec.algorithm {
        AlgorithmSettings::Sample(_) | AlgorithmSettings::Discover { .. } => None,
        AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(_) => reader.estimate(row.id).await?,
    };
    let prior_draws = match spec.algorithm {
        AlgorithmSettings::Sample(_) => reader.prior_draws(row.id, spec.algorithm.width()).await?,
        AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(_) | AlgorithmSettings::Discover { .. } => {
            Vec::new()
        }
    };
    let mut populations = reader.populations(row.id).await?;
    // The draws of a normal approximation belong to no stage.
    let posterior = match populations.pop() {
        Some(last) => last,
        None => reader.samples(row.id, None).await?,
    };
    if let AlgorithmSettings::Sample(_) = spec.algorithm {
        populations.insert(0, first_population(&spec, &prior_draws));
    }
    let at_likeliest = reader.likeliest(row.id).await?;
    // Programs of scm-5 and before left out readings and derivatives where they simulated histories.
    let whole = at_likeliest.as_ref().filter(|observables| {
        let histories = spec.fit_variant.with_histories();
        observables.covers(histories.as_ref().unwrap_or(&spec.fit_variant))
    });
    let likeliest_values = match (whole, likeliest(&posterior)) {
        (_, None) => None,
        (Some(observables), Some(_)) => Some(spec.predicted_values(observables)),
        (None, Some(sample)) => reader.fitted_values(row.id, &sample.theta).await?,
    };
    let simulated_histories = at_likeliest
        .map(|observables| observables.histories)
        .filter(|histories| !histories.is_empty());
    let subchains = match spec.algorithm.has_metamodel() {
        true => reader.subchains(row.id).await?,
        false => None,
    };
    let sampled = SampledPosterior {
        draws: posterior,
        populations,
        prior_draws,
        stages: reader.stages(row.id).await?,
        subchains,
    };
    let outcome = Outcome::new(estimate, sampled);
    Ok(FinishedCalibration {
        spec,
        outcome,
        experiment: row.name.clone(),
        likeliest_values,
        predictions: reader.predictions(row.id).await?,
        simulated_histories,
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

/// Loads what is finished of the study of a finished calibration.
///
/// # Errors
/// As those of [`finished_calibration`].
pub async fn finished_study(reader: &Reader, row: &CalibrationRow) -> Result<Study, ServiceError> {
    finished_study_of(reader, row, &reader.study(row.study).await?).await
}

/// The same from members that were read: a member that joins meanwhile is no part of it.
pub(super) async fn finished_study_of(
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
    // Without any, the calibration that was asked for says why there is nothing to show.
    let lead = best.or(calibrations.first()).copied().unwrap_or(row);
    let mut experiments = ParsedExperiments::default();
    let lead = finished_with(reader, lead, &mut experiments).await?;
    let (mut others, mut point_estimates, mut extensions) = (Vec::new(), Vec::new(), Vec::new());
    for row in calibrations.into_iter().filter(|row| row.id != lead.row.id) {
        if compared(row) {
            others.push(finished_with(reader, row, &mut experiments).await?);
            continue;
        }
        let beside = match lineage.model_of(row.id) == lineage.model_of(lead.row.id) {
            true => &mut point_estimates,
            false => &mut extensions,
        };
        beside.push(finished_with(reader, row, &mut experiments).await?);
    }
    let state = match unfinished {
        Some(row) => row.state,
        // What is decided but not yet begun is work to come.
        None if next_step_from(reader, rows).await?.is_some() => CalibrationState::Running,
        None => CalibrationState::Finished,
    };
    Ok(Study {
        state,
        models,
        lead,
        others,
        point_estimates,
        extensions,
        rounds: search_rounds(reader, rows).await?,
        members: study_members(reader, rows).await?,
        combined: OnceLock::new(),
    })
}

/// The finished searches of a study.
///
/// # Errors
/// As those of [`finished_calibration`].
pub async fn search_rounds(
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
