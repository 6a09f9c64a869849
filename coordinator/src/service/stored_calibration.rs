//! A stored calibration: its row, its specification, its status.

use std::collections::BTreeMap;
use std::sync::Arc;

use shared::api::{CalibrationState, CalibrationStatus};
use shared::experiment::Experiment;
use shared::file::FileSet;

use super::error::ServiceError;
use job::{Job, Spec, model_kind};
use record::{CalibrationRow, Role};
use store::{Reader, StoreError};

/// Names of a job and its experiment in messages.
pub(super) const FILES: [&str; 2] = ["job.toml", "experiment.toml"];

pub(super) async fn calibration_row(reader: &Reader, id: i64) -> Result<CalibrationRow, ServiceError> {
    let row = reader.calibration(id).await?;
    row.ok_or_else(|| ServiceError::not_found("calibration", id))
}

pub(super) async fn experiment_files(reader: &Reader, id: i64) -> Result<FileSet, ServiceError> {
    let row = reader.experiment(id).await?;
    Ok(row
        .ok_or_else(|| ServiceError::not_found("experiment", id))?
        .files)
}

pub(super) async fn spec_of(reader: &Reader, row: &CalibrationRow) -> Result<Spec, ServiceError> {
    ParsedExperiments::default().spec_of(reader, row).await
}

/// The experiments that the calibrations of a study share, each parsed once.
#[derive(Debug, Default)]
pub(super) struct ParsedExperiments(BTreeMap<i64, Arc<Experiment>>);

impl ParsedExperiments {
    pub(super) async fn spec_of(
        &mut self,
        reader: &Reader,
        row: &CalibrationRow,
    ) -> Result<Spec, ServiceError> {
        let [job_name, experiment_name] = FILES;
        let job = Job::read(job_name, &row.job)?;
        let job = match row.membership.role {
            Role::Search => job.into_search(),
            Role::Sample | Role::Fit => job,
        };
        let experiment = match self.0.get(&row.experiment) {
            Some(experiment) => Arc::clone(experiment),
            None => {
                let files = experiment_files(reader, row.experiment).await?;
                let experiment = Arc::new(Experiment::parse(experiment_name, &files)?);
                self.0.insert(row.experiment, Arc::clone(&experiment));
                experiment
            }
        };
        Ok(Spec::from_values(job_name, job, experiment_name, experiment)?)
    }
}

/// Returns whether a calibration has, or will have, draws of the posterior: those of a sampler, or of a fit's normal approximation. Fits of
/// earlier versions have none, so for a finished fit the store decides.
pub(super) async fn has_posterior(reader: &Reader, row: &CalibrationRow) -> Result<bool, ServiceError> {
    Ok(match row.membership.role {
        Role::Sample => true,
        Role::Search => false,
        Role::Fit if row.state == CalibrationState::Finished => {
            !reader.samples(row.id, None).await?.is_empty()
        }
        Role::Fit => Job::parse(FILES[0], &row.job.toml)?.algorithm.has_posterior(),
    })
}

/// Makes the status of a stored calibration that is not in the farm. A calibration whose row cannot be read still has a line in every list.
pub(super) fn stored_status(id: i64, row: &Result<CalibrationRow, StoreError>) -> CalibrationStatus {
    let row = match row {
        Ok(row) => row,
        Err(error) => {
            return CalibrationStatus {
                id,
                name: String::new(),
                study: 0,
                experiment: 0,
                state: CalibrationState::Failed,
                message: Some(error.to_string()),
                model_kind: None,
                model_version: None,
                progress: None,
            };
        }
    };
    CalibrationStatus {
        id,
        name: row.name.clone(),
        study: row.study,
        experiment: row.experiment,
        state: row.state,
        message: row.message.clone(),
        model_kind: model_kind(&row.job.toml).map(|kind| kind.name().to_owned()),
        model_version: row.model_version.clone(),
        progress: None,
    }
}
