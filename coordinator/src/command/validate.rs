//! `coordinator validate`: predicts each level of a factor by a calibration on the other levels.
//!
//! The calibrations are stored in another folder below the run, because they are no part of its study, whose ledger compares models on the
//! same measurements. A later call resumes them, and `--out` shows them like any other.

use std::path::Path;

use anyhow::{Context, bail};
use shared::api::{CalibrationState, NewCalibration, NewExperiment};
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::model::equations_of;

use super::folder::Folder;
use super::output::{note, say};
use super::place::Place;
use crate::config::{ValidateArguments, ValidationFormat};
use crate::service::ServiceError;
use job::{Spec, validation_job};
use record::CalibrationRow;
use report::terminal;
use result::FinishedCalibration;
use result::validation::{LeftOutLevel, ValidatedLevel, Validation};
use store::IdPage;

/// Names of job and experiment in messages.
const FILES: [&str; 2] = ["job.toml", "experiment.toml"];

pub(super) async fn validate(config: &ValidateArguments) -> anyhow::Result<()> {
    let place = Place::open(&config.target.source).await?;
    let (Place::Folder { service, .. }, Some(out)) = (&place, &config.target.source.out) else {
        bail!(
            "validate needs --out: it calibrates in a folder of a run; a service answers POST /v1/calibrations/ID/what-if for a level \
             at a time"
        );
    };
    let id = place.id(&config.target).await?;
    let calibration = service.finished_calibration(id).await?;
    let factor = config.leave_out.into();
    let levels = LeftOutLevel::all(&calibration.spec, factor).map_err(anyhow::Error::msg)?;
    let rest = Rest {
        experiment: service.experiment(calibration.row.experiment).await?,
        job: validation_job(FILES[0], &calibration.row.job, config.own_algorithm)?,
        calibration,
    };
    let algorithm = Spec::new(FILES[0], &rest.job, FILES[1], &rest.experiment)?
        .algorithm
        .algorithm_name();
    let beside = out.join(format!("validation-{id}"));
    std::fs::create_dir_all(&beside).with_context(|| beside.display().to_string())?;
    let mut folder = Folder::open(&beside, config.local_workers, &config.models, None).await?;
    let service = folder.service.clone();
    let validated = async {
        let mut validated = Vec::new();
        for level in levels {
            note(&format!("without {}", level.name));
            validated.push(rest.predict(level, &mut folder).await?);
        }
        Ok::<_, anyhow::Error>(validated)
    };
    let validated = validated.await;
    service.close().await;
    let validation = Validation::new(&rest.calibration, factor, algorithm, validated?);
    let json = serde_json::to_string_pretty(&validation)? + "\n";
    write(&beside.join(format!("{}.json", factor.name())), &json)?;
    Ok(say(&match config.format {
        ValidationFormat::Text => terminal::validation(&validation),
        ValidationFormat::Json => json,
    })?)
}

/// Writes a text to a temporary name first, so that the file is never incomplete under its final name.
fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    let partial = path.with_extension("json.part");
    std::fs::write(&partial, text).with_context(|| partial.display().to_string())?;
    std::fs::rename(&partial, path).with_context(|| path.display().to_string())
}

/// The validation of a calibration by leaving out levels.
struct Rest {
    /// The calibration whose model predicts.
    calibration: FinishedCalibration,
    experiment: FileSet,
    /// The job of every level.
    job: FileSet,
}

impl Rest {
    /// Predicts a level from the others. Where this is impossible, the result is the reason.
    async fn predict(&self, level: LeftOutLevel, folder: &mut Folder) -> anyhow::Result<ValidatedLevel> {
        let edited = match Experiment::with_held_out(FILES[1], &self.experiment, &level.runs) {
            Ok(edited) => edited,
            Err(error) => return Ok(ValidatedLevel::refused(level, error.to_string())),
        };
        let study = match self.earlier(&edited, folder).await? {
            Some(row) => {
                folder.go_on(row.study).await?;
                row.study
            }
            None => match self.add(&level, edited, folder).await {
                Ok(study) => study,
                Err(ServiceError::File(error)) => {
                    return Ok(ValidatedLevel::refused(level, error.to_string()));
                }
                Err(error) => return Err(error.into()),
            },
        };
        folder.bring_to_end(study).await?;
        let reader = folder.service.store().reader();
        let rows = reader.study(study).await?;
        let row = rows.first().context("a study has a calibration")?;
        match row.state {
            CalibrationState::Finished => {
                let predicting = folder.service.finished_calibration(row.id).await?;
                Ok(ValidatedLevel::predicted(level, &self.calibration, &predicting))
            }
            _ => {
                let message = row.message.clone().unwrap_or_default();
                Ok(ValidatedLevel::refused(
                    level,
                    format!("{}: {message}", row.state.name()),
                ))
            }
        }
    }

    /// Returns the calibration of an earlier call on these runs with the same equations.
    async fn earlier(&self, edited: &FileSet, folder: &Folder) -> anyhow::Result<Option<CalibrationRow>> {
        let service = &folder.service;
        let equations = folder.equations_of(&self.calibration.spec).await?;
        for (_, row) in service.store().reader().calibrations(IdPage::ALL).await? {
            let row = row?;
            let pinned = row.model_version.as_deref().map(equations_of);
            let is_same_version = pinned.is_none() || pinned == equations.as_deref();
            if is_same_version && row.job == self.job && service.experiment(row.experiment).await? == *edited
            {
                return Ok(Some(row));
            }
        }
        Ok(None)
    }

    async fn add(&self, level: &LeftOutLevel, edited: FileSet, folder: &Folder) -> Result<i64, ServiceError> {
        // The job is validated before anything is stored.
        Spec::new(FILES[0], &self.job, FILES[1], &edited)?;
        let experiment = NewExperiment {
            toml: edited.toml,
            files: edited.files,
        };
        let new = NewCalibration {
            experiment: folder.service.add_experiment(experiment).await?,
            toml: self.job.toml.clone(),
            files: self.job.files.clone(),
            name: Some(format!("{} without {}", self.calibration.row.name, level.name)),
            webhook: None,
        };
        Ok(folder.service.add_calibration(new).await?.study)
    }
}
