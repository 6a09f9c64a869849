//! A calibration as its files determine it.
//!
//! # Layout
//! - `parameters`: which parameters are fixed and which are free, with their priors.
//! - `fitted`: the measurements that are fitted, with their likelihood.
//! - `variants`: the model variants that workers evaluate.
//! - `words`: the description of a specification for terminals and reports.

mod fitted;
mod parameters;
mod variants;
mod words;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use shared::experiment::Experiment;
use shared::file::{FileError, FileSet};
use shared::model::{ModelSettings, ModelVariant, equations_of};
use shared::outcome::Observables;
use shared::predicted::PredictedValue;
use statistics::{Discrepancy, Likelihood, LikelihoodError, LogLikelihood, Prior};

use crate::data::bevameter_readings::{BevameterReadings, PLATE};
use crate::data::error::DataError;
use crate::data::rig_groups::preparations;
use crate::data::shared_error::SharedError;
use crate::data::shared_sd::StiffnessErrors;
use crate::data::transient_readings::TransientReadings;
use crate::job::{Job, JobModels};
use crate::named_files::NamedFiles;
use crate::table::algorithm_settings::AlgorithmSettings;
use crate::table::discovery_settings::DiscoverySettings;
use crate::table::likelihood_settings::LikelihoodSettings;
use crate::table::posterior_prior::JointPrior;
use crate::table::prior_entry::FreeParameter;
use fitted::Fitted;
use parameters::{Parameters, joint};
use variants::Variants;

/// A calibration as its files determine it; equal files give an equal specification.
#[derive(Debug, Clone)]
pub struct Spec {
    /// The measured data set.
    pub experiment: Arc<Experiment>,
    /// The forward model with its fixed parameters.
    pub model: ModelSettings,
    /// The free parameters with their priors, in the order of every parameter vector.
    pub parameters: Vec<FreeParameter>,
    /// The posterior of another calibration that is the prior of the first parameters, if the job states one.
    pub joint_prior: Option<JointPrior>,
    /// The algorithm with its settings.
    pub algorithm: AlgorithmSettings,
    /// The fits and searches that stand beside the sample in its study.
    pub point_estimates: Vec<AlgorithmSettings>,
    /// The fitted runs, as positions in the experiment.
    pub fit_runs: Vec<usize>,
    /// The runs that are not fitted, as positions in the experiment.
    pub holdout_runs: Vec<usize>,
    /// The variant of the fitted runs.
    pub fit_variant: ModelVariant,
    /// The variant of the holdout runs, which workers evaluate for the final draws alone; `None` without holdout runs.
    pub holdout_variant: Option<ModelVariant>,
    /// The likelihood of the measurements that are fitted; runs count within [`Spec::fit_runs`].
    pub likelihood: Likelihood,
    /// The errors that fitted runs share: scatter of the soil, offsets of sessions, tarings and operators.
    pub shared_errors: Vec<SharedError>,
    /// The observables that the likelihood takes.
    predicted: Vec<PredictedValue>,
    /// Values of parameters by independent tests. The figures alone show them.
    pub reference: BTreeMap<String, f64>,
    /// The settings of the likelihood, as the job states them.
    pub likelihood_settings: LikelihoodSettings,
    /// The measured readings of plates and rings; all are fitted.
    pub bevameter: BevameterReadings,
    /// The recorded sinkages before the steady state, if the job fits them.
    pub transients: TransientReadings,
    /// The search of its study for missing effects.
    pub discovery: DiscoverySettings,
    /// Names of the plausibility questions whose odd values are intended.
    pub accepted: Vec<String>,
    /// Texts of the effects that a search tries beside the catalogue, in the order of the job.
    pub candidates: Vec<String>,
    /// Number of models that the job compares, this one included; 1 if it has a table `[model]`.
    pub models: usize,
}

/// A calibration was begun with other files of its effects than this program has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the effect files have changed: the calibration was started with model version {begun}, this program has {now}"
)]
pub struct EffectsChanged {
    /// The version that the calibration is pinned to.
    pub begun: String,
    /// The version that the effects of this program give.
    pub now: String,
}

/// Largest number of final draws that are simulated on every run, holdout included.
pub const PREDICTION_DRAWS: usize = 200;

/// Largest number of predicted values of one population: 400 MB.
const MAX_NUMBERS: usize = 50_000_000;

impl Spec {
    /// Builds and validates the specification of a job and its experiment, both as texts.
    ///
    /// # Errors
    /// [`FileError`] names the file, the line or field, the value, the unit and the bound.
    pub fn new(
        job_name: &str,
        job: &FileSet,
        experiment_name: &str,
        files: &FileSet,
    ) -> Result<Spec, FileError> {
        let job = Job::read(job_name, job)?;
        let experiment = Experiment::parse(experiment_name, files)?;
        Spec::from_values(job_name, job, experiment_name, Arc::new(experiment))
    }

    /// Builds and validates the specification of a job and its experiment, both as values.
    ///
    /// # Errors
    /// The errors of [`Spec::new`].
    pub fn from_values(
        job_name: &str,
        job: Job,
        experiment_name: &str,
        experiment: Arc<Experiment>,
    ) -> Result<Spec, FileError> {
        let in_job = |message: String| FileError::whole(job_name, message);
        let candidates = job.candidate_files.iter();
        let candidates = candidates
            .filter_map(|file| job.files.text(file).map(str::to_owned))
            .collect();
        let in_data = |error: DataError| FileError::whole(experiment_name, error.to_string());
        let bevameter = BevameterReadings::new(&experiment).map_err(in_data)?;
        let stiffness = StiffnessErrors {
            has_derivatives: job.model.external.is_none(),
            has_unknown_discrepancy: job.likelihood.discrepancies.contains(&Discrepancy::Unknown),
        };
        let transients = match job.likelihood.histories {
            true => TransientReadings::new(&experiment).map_err(in_data)?,
            false => TransientReadings::default(),
        };
        let readings = (&bevameter, &transients);
        let parameters = Parameters::new(job_name, &job, &experiment, readings, stiffness)?;
        let fitted = Fitted::new(&experiment, readings, &parameters.free, job.likelihood, stiffness);
        let fitted = fitted.map_err(in_data)?;
        check_algorithms(&job, parameters.free.len(), fitted.predicted.len()).map_err(in_job)?;
        let variants = Variants::new(&experiment, readings, &parameters, &fitted).map_err(in_job)?;
        Ok(Spec {
            experiment,
            model: parameters.model,
            parameters: parameters.free,
            joint_prior: parameters.joint_prior,
            algorithm: job.algorithm,
            point_estimates: job.point_estimates,
            fit_runs: fitted.fit_runs,
            holdout_runs: fitted.holdout_runs,
            fit_variant: variants.fit,
            holdout_variant: variants.holdout,
            likelihood: fitted.likelihood,
            shared_errors: fitted.shared_errors,
            predicted: fitted.predicted,
            reference: job.reference,
            likelihood_settings: job.likelihood,
            bevameter,
            transients,
            discovery: job.discovery,
            accepted: job.accepted,
            candidates,
            models: job.models,
        })
    }

    /// Returns the specifications of every model that a job compares, in the order of the job.
    ///
    /// # Errors
    /// The errors of [`Spec::new`]; an error of a model as a whole has the line of its `[[models]]`.
    pub fn of_models(
        job_name: &str,
        models: JobModels,
        texts: &BTreeMap<String, String>,
        experiment_name: &str,
        files: &FileSet,
    ) -> Result<Vec<Spec>, FileError> {
        let experiment = Arc::new(Experiment::parse(experiment_name, files)?);
        let texts = NamedFiles::from(texts);
        let spec = |job: Job| {
            let (line, kind) = (job.line, job.model.kind.name());
            let job = job.beside(texts.clone());
            let spec = Spec::from_values(job_name, job, experiment_name, Arc::clone(&experiment));
            spec.map_err(
                |error| match line.filter(|_| error.line.is_none() && error.file == job_name) {
                    Some(line) => {
                        FileError::at(job_name, line, format!("[[models]] {kind}: {}", error.message))
                    }
                    None => error,
                },
            )
        };
        std::iter::once(models.first)
            .chain(models.others)
            .map(spec)
            .collect()
    }

    /// Returns the variant that workers evaluate while sampling: the fitted runs with the channels that the likelihood takes.
    pub fn sampled_variant(&self) -> ModelVariant {
        let fitted: BTreeSet<_> = self
            .predicted
            .iter()
            .filter_map(|value| value.channel())
            .collect();
        let mut variant = ModelVariant {
            channels: fitted.into_iter().collect(),
            ..self.fit_variant.clone()
        };
        self.transients.keep_data(&mut variant);
        variant
    }

    /// Returns the predicted values that the likelihood takes from an evaluation of the fitted runs.
    pub fn predicted_values(&self, observables: &Observables) -> Vec<f64> {
        self.predicted
            .iter()
            .map(|value| value.select(observables))
            .collect()
    }

    /// Returns ln p(data | theta) of an evaluation of the fitted runs; where the model rejected the parameters, the data are impossible.
    ///
    /// # Errors
    /// [`LikelihoodError`]: the predicted values do not fit the likelihood.
    pub fn log_likelihood(
        &self,
        observables: Option<&Observables>,
        theta: &[f64],
    ) -> Result<LogLikelihood, LikelihoodError> {
        let Some(observables) = observables else {
            return Ok(LogLikelihood::Impossible);
        };
        let values = self.predicted_values(observables);
        match self.likelihood.log_likelihood(&values, theta) {
            // A draw from the tail of a prior may have a standard deviation or a correlation length of zero. This is a property of theta,
            // not an error of the model; what the files state was checked before.
            Err(LikelihoodError::Noise { .. } | LikelihoodError::Setting { .. }) => {
                Ok(LogLikelihood::Impossible)
            }
            scored => scored,
        }
    }

    /// Returns the number of preparations of the soil of the fitted runs; each run without an id counts as one.
    pub fn preparations(&self) -> usize {
        preparations(&self.experiment, &self.fit_runs).len()
    }

    /// Returns the fitted measurements of wheels.
    pub fn wheel_data(&self) -> usize {
        self.likelihood
            .data()
            .iter()
            .filter(|d| d.channel < PLATE)
            .count()
    }

    /// Returns whether another specification is the same calibration; comments, the order of keys and accepted questions do not count.
    pub fn same_as(&self, other: &Spec) -> bool {
        // Debug output shows every number to the last bit.
        let text = |spec: &Spec| {
            let accepted = Vec::new();
            format!(
                "{:?}",
                Spec {
                    accepted,
                    ..spec.clone()
                }
            )
        };
        text(self) == text(other)
    }

    /// Checks that the effects are those of the version that a calibration is pinned to; its equations are the
    /// workers' concern.
    ///
    /// # Errors
    /// [`EffectsChanged`].
    pub fn check_effects(&self, pinned: &str) -> Result<(), EffectsChanged> {
        let now = self.fit_variant.model_version(equations_of(pinned));
        if now == pinned {
            return Ok(());
        }
        let begun = pinned.to_owned();
        Err(EffectsChanged { begun, now })
    }

    /// Returns the joint prior, in parameter order.
    pub fn prior(&self) -> Prior {
        joint(&self.joint_prior, &self.parameters).expect("checked when the specification was made")
    }

    /// Returns the part of a parameter vector that the model takes: everything but the noise sds.
    ///
    /// Noise parameters stand behind the model's, so this is a prefix.
    pub fn model_theta<'a>(&self, theta: &'a [f64]) -> &'a [f64] {
        &theta[..self.fit_variant.parameters.len()]
    }
}

/// Checks that the algorithms can work with these numbers of parameters and fitted values.
fn check_algorithms(job: &Job, parameters: usize, values: usize) -> Result<(), String> {
    if parameters == 0 {
        return Err("[priors] leaves no parameter free: there is nothing to calibrate".into());
    }
    for algorithm in std::iter::once(&job.algorithm).chain(&job.point_estimates) {
        algorithm
            .check(parameters)
            .map_err(|e| format!("[sampler] {e}"))?;
    }
    match &job.algorithm {
        AlgorithmSettings::Sample(settings) if settings.particles.saturating_mul(values) > MAX_NUMBERS => {
            Err(format!(
                "[sampler] {} particles of {values} fitted values each are {} numbers; they must be at most {MAX_NUMBERS}",
                settings.particles,
                settings.particles.saturating_mul(values)
            ))
        }
        _ => Ok(()),
    }
}
