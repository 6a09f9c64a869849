//! Submission of experiments and calibrations: they are validated, stored and started.

use std::sync::Arc;

use shared::api::{CalibrationCreated, NewCalibration, NewExperiment};
use shared::experiment::Experiment;
use shared::file::{FileError, FileSet};

use super::background::in_background;
use super::clock::now_ms;
use super::error::ServiceError;
use super::handle::Service;
use farm::calibration::{Calibration, CalibrationIdentity};
use job::{
    AlgorithmSettings, Job, ServiceEffect, Spec, check_accepted, model_job, point_job, with_service_effects,
    without_service_effects,
};
use record::{Change, Membership, Role};
use store::{NewCalibrationRow, NewStudy, StudyIds};

/// Longest name of a calibration `[bytes]`.
const LONGEST_NAME: usize = 200;

impl Service {
    /// Validates and stores an experiment, and returns its id.
    pub async fn add_experiment(&self, new: NewExperiment) -> Result<i64, ServiceError> {
        let files = FileSet {
            toml: new.toml,
            files: new.files,
        };
        Experiment::parse("experiment.toml", &files)?;
        Ok(self.store().writer().add_experiment(files, now_ms()).await?)
    }

    /// Validates and stores a calibration and the point estimates that its job asks for, and gives them to the farm.
    pub async fn add_calibration(&self, new: NewCalibration) -> Result<CalibrationCreated, ServiceError> {
        if let Some(url) = &new.webhook {
            self.webhook_hosts.check(url)?;
        }
        let experiment = self.experiment(new.experiment).await?;
        let name = new.name.unwrap_or_else(|| "calibration".into());
        if name.len() > LONGEST_NAME {
            let message = format!("{} bytes must be at most {LONGEST_NAME} bytes", name.len());
            return Err(FileError::whole("name", message).into());
        }
        let job = FileSet {
            toml: new.toml,
            files: new.files,
        };
        let service_effects = self.listed_user_effects(&job).await?;
        // The samplers are made before anything is stored, so that a job which they refuse leaves no rows.
        let trial = CalibrationIdentity {
            id: 0,
            name,
            study: 0,
            experiment: new.experiment,
        };
        let members = in_background(move || members(&trial, job, &service_effects, &experiment)).await?;
        let (members, rows): (Vec<Calibration>, Vec<NewCalibrationRow>) = members.into_iter().unzip();
        let study = NewStudy {
            experiment: new.experiment,
            calibrations: rows,
            webhook: new.webhook,
            now_ms: now_ms(),
        };
        let StudyIds { study, calibrations } = self.store().writer().add_study(study).await?;
        for (mut calibration, &id) in members.into_iter().zip(&calibrations) {
            (calibration.identity.id, calibration.identity.study) = (id, study);
            self.take_in_hand(calibration).await?;
        }
        let (id, point_estimates) = calibrations.split_first().expect("a study begins with its job");
        Ok(CalibrationCreated {
            id: *id,
            study,
            point_estimates: point_estimates.to_vec(),
        })
    }
}

/// Makes the first calibrations of a job's study, each with a job of its own: the job itself, then the other models that it compares, or
/// the point estimates that it requests. Effects of the service's catalogue that the job lists become files of it.
fn members(
    identity: &CalibrationIdentity,
    job: FileSet,
    service_effects: &[ServiceEffect],
    experiment: &FileSet,
) -> Result<Vec<(Calibration, NewCalibrationRow)>, ServiceError> {
    let file = "job.toml";
    let mut specs = specs_of(&job, service_effects, experiment)?;
    let job = with_service_effects(file, job, service_effects)?;
    let alternatives = specs.split_off(1);
    let spec = specs.remove(0);
    let point_estimates = spec.point_estimates.clone();
    let experiment = Arc::clone(&spec.experiment);
    let spec_of = |job: &FileSet| -> Result<Spec, FileError> {
        Spec::from_values(
            file,
            Job::read(file, job)?,
            "experiment.toml",
            Arc::clone(&experiment),
        )
    };
    let mut members = vec![member(identity.name.clone(), None, spec, job.clone(), identity)?];
    for (number, spec) in (1..).zip(alternatives) {
        let alone = model_job(file, &job, number)?;
        let name = format!("{} ({})", identity.name, spec.model.kind.name());
        let spec = spec_of(&alone)?;
        members.push(member(name, Some(Change::Model(number)), spec, alone, identity)?);
    }
    for algorithm in &point_estimates {
        let job = point_job(file, &job, algorithm)?;
        let spec = spec_of(&job)?;
        let name = format!("{} ({})", identity.name, algorithm.name());
        let change = Change::Algorithm(algorithm.name().to_owned());
        members.push(member(name, Some(change), spec, job, identity)?);
    }
    Ok(members)
}

/// Reads the models of a job. Effects of the service's catalogue that the job lists count as files of it.
pub(super) fn specs_of(
    job: &FileSet,
    service_effects: &[ServiceEffect],
    experiment: &FileSet,
) -> Result<Vec<Spec>, ServiceError> {
    let file = "job.toml";
    // Messages name the lines of the user's file; the stored job has the files of users' effects.
    let mut parsed = Job::parse_models(file, &without_service_effects(file, &job.toml, service_effects)?)?;
    parsed.first.check_files(file, &job.files)?;
    let names: Vec<String> = service_effects.iter().map(|effect| effect.file.clone()).collect();
    let added = parsed.first.list_effects(&[], &names);
    added.map_err(|e| FileError::whole(file, e))?;
    let job = with_service_effects(file, job.clone(), service_effects)?;
    let specs = Spec::of_models(file, parsed, &job.files, "experiment.toml", experiment)?;
    for spec in &specs {
        check_accepted(spec).map_err(|e| FileError::whole(file, e.to_string()))?;
    }
    Ok(specs)
}

/// Makes a calibration with its row, in which the store fills in the parent.
fn member(
    name: String,
    change: Option<Change>,
    spec: Spec,
    job: FileSet,
    identity: &CalibrationIdentity,
) -> Result<(Calibration, NewCalibrationRow), ServiceError> {
    let membership = Membership {
        role: role_of(&spec.algorithm),
        parent: None,
        change,
    };
    let identity = CalibrationIdentity {
        name: name.clone(),
        ..identity.clone()
    };
    let calibration = Calibration::new(identity, Arc::new(spec))?;
    Ok((
        calibration,
        NewCalibrationRow {
            membership,
            name,
            job,
        },
    ))
}

/// Returns the role of a calibration with an algorithm.
pub(super) fn role_of(algorithm: &AlgorithmSettings) -> Role {
    match algorithm {
        AlgorithmSettings::Sample(_) => Role::Sample,
        AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(_) => Role::Fit,
        AlgorithmSettings::Discover { .. } => Role::Search,
    }
}
