//! A calibration as its files determine it.

use std::collections::{BTreeMap, BTreeSet};

use shared::experiment::{Experiment, RunUse};
use shared::file::{FileError, FileSet, number};
use shared::model::{
    Companion, EffectSet, ModelKind, ModelSettings, ModelVariant, ParameterScope, equations_of,
};
use shared::outcome::Observables;
use shared::parameters;
use shared::predicted::PredictedValue;
use statistics::{Likelihood, Prior, PriorError};

use crate::data::bevameter_readings::{BevameterReadings, PLATE};
use crate::data::error::DataError;
use crate::data::likelihood::likelihood;
use crate::data::noise;
use crate::data::outside_model;
use crate::data::predicted_values::predicted_values;
use crate::data::soil_scatter::{BY_STIFFNESS, SoilScatter};
use crate::job_file::{JobFile, JobModels};
use crate::table::algorithm_settings::AlgorithmSettings;
use crate::table::discovery_settings::DiscoverySettings;
use crate::table::likelihood_settings::LikelihoodSettings;
use crate::table::posterior_prior::JointPrior;
use crate::table::prior_entry::{FreeParameter, ParsedPrior};

/// A calibration as its files determine it; equal files give an equal specification.
#[derive(Debug, Clone)]
pub struct Spec {
    /// The measured data set.
    pub experiment: Experiment,
    /// Which forward model, with its fixed parameters.
    pub model: ModelSettings,
    /// The free parameters with their priors, in the order of every parameter vector.
    pub parameters: Vec<FreeParameter>,
    /// The posterior of another calibration that is the prior of the first of them, if there is one.
    pub joint_prior: Option<JointPrior>,
    /// The algorithm with its settings.
    pub algorithm: AlgorithmSettings,
    /// The fits and searches that stand beside the sample in its study.
    pub point_estimates: Vec<AlgorithmSettings>,
    /// The fitted runs, as positions in the experiment.
    pub fit_runs: Vec<usize>,
    /// The runs that are not fitted, as positions in the experiment.
    pub holdout_runs: Vec<usize>,
    /// The fitted runs, with everything that the model says of them.
    pub fit_variant: ModelVariant,
    /// What workers evaluate for the final draws besides: the holdout runs, if there are any.
    pub holdout_variant: Option<ModelVariant>,
    /// The likelihood of the measurements that are fitted; runs count within [`Spec::fit_runs`].
    pub likelihood: Likelihood,
    /// How the soil scatters from run to run and from preparation to preparation.
    pub scatters: Vec<SoilScatter>,
    /// Which of the observables it takes.
    predicted: Vec<PredictedValue>,
    /// What an independent test says of parameters; the figures show it, nothing else reads it.
    pub reference: BTreeMap<String, f64>,
    /// What the job says of the errors.
    pub likelihood_settings: LikelihoodSettings,
    /// The measured readings of plates and rings; all are fitted.
    pub bevameter: BevameterReadings,
    /// Whether its study looks for missing effects.
    pub discovery: DiscoverySettings,
    /// Names of the questions that its job answers: what looks odd, and is meant.
    pub accepted: Vec<String>,
    /// How many models the job compares, of which this is one; 1 where it has a table `[model]`.
    pub models: usize,
}

/// A calibration was begun with other files of its effects than this program has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the effect files have changed: the calibration was started with model version {begun}, this program has {now}"
)]
pub struct EffectsChanged {
    /// The version that it is pinned to.
    pub begun: String,
    /// The same equations with the effects as they are now.
    pub now: String,
}

/// At most so many final draws are simulated on every run, holdout included.
pub const PREDICTION_DRAWS: usize = 200;

/// Most predicted values of one population: 400 MB.
const MOST_NUMBERS: usize = 50_000_000;

impl Spec {
    /// Builds and validates a specification.
    ///
    /// # Errors
    /// [`FileError`] names the file, the line or field, the value, the unit and the bound.
    pub fn new(
        job_name: &str,
        job: &FileSet,
        experiment_name: &str,
        files: &FileSet,
    ) -> Result<Spec, FileError> {
        let parsed = JobFile::parse(job_name, &job.toml)?;
        Spec::of(job_name, parsed, &job.files, experiment_name, files)
    }

    /// The specification of the search for missing effects of a job's model.
    ///
    /// # Errors
    /// As those of [`Spec::new`].
    pub fn of_search(
        job_name: &str,
        job: &FileSet,
        experiment_name: &str,
        files: &FileSet,
    ) -> Result<Spec, FileError> {
        let parsed = JobFile::parse(job_name, &job.toml)?.into_search();
        Spec::of(job_name, parsed, &job.files, experiment_name, files)
    }

    /// The same of a job that is parsed, with the texts of the files that it names.
    ///
    /// # Errors
    /// As those of [`Spec::new`].
    pub fn of(
        job_name: &str,
        job: JobFile,
        texts: &BTreeMap<String, String>,
        experiment_name: &str,
        files: &FileSet,
    ) -> Result<Spec, FileError> {
        let experiment = Experiment::parse(experiment_name, files)?;
        Spec::measured(job_name, job, texts, experiment_name, experiment)
    }

    /// The same where the experiment is parsed, too.
    ///
    /// # Errors
    /// As those of [`Spec::new`].
    pub fn measured(
        job_name: &str,
        job: JobFile,
        texts: &BTreeMap<String, String>,
        experiment_name: &str,
        experiment: Experiment,
    ) -> Result<Spec, FileError> {
        let in_job = |message: String| FileError::whole(job_name, message);
        let in_data = |error: DataError| FileError::whole(experiment_name, error.to_string());
        let bevameter = BevameterReadings::new(&experiment).map_err(in_data)?;
        let wheels = experiment.wheel_names();
        let mut model = job.model;
        let named = job.priors.iter().map(|entry| entry.name.as_str());
        let named = named.filter(|name| !name.starts_with(parameters::NOISE_PREFIX));
        let fixed = model.fixed.keys().map(String::as_str);
        let of_effects = named
            .chain(fixed)
            .filter(|name| *name != parameters::RING_TRANSFER);
        let effects = EffectSet::choose(job_name, (&model.effects, &model.effect_files), of_effects, texts)?;
        let external = model.external.clone();
        let scope = ParameterScope {
            wheels: &wheels,
            effects: &effects,
            external: external.as_ref(),
        };
        let mut parameters = Vec::new();
        let mut joint_prior = None;
        if let Some(posterior) = job.posterior {
            let text = texts
                .get(&posterior.file)
                .ok_or_else(|| in_job(format!("file \"{}\" is named but was not sent", posterior.file)))?;
            let entry = |name: &str| job.priors.iter().find(|entry| entry.name == name);
            let fixed = |name: &str| {
                let stated = || entry(name).and_then(|entry| number(&entry.value));
                model.fixed.get(name).copied().or_else(stated)
            };
            let is_said = |name: &str| entry(name).is_some() || model.fixed.contains_key(name);
            let (joint, covered) = posterior.fit(text, fixed, is_said, &scope)?;
            joint_prior = Some(joint);
            parameters = covered;
        }
        for entry in job.priors {
            match entry
                .parse(&scope)
                .map_err(|e| FileError::at(job_name, entry.line, e.to_string()))?
            {
                ParsedPrior::Fixed(value) => {
                    if model.fixed.insert(entry.name.clone(), value).is_some() {
                        let message = format!(
                            "{} is fixed under [model] and stands again under [priors]",
                            entry.name
                        );
                        return Err(FileError::at(job_name, entry.line, message));
                    }
                }
                ParsedPrior::Free(parameter) => parameters.push(parameter),
            }
        }
        for own in model.kind.parameters() {
            let said = parameters.iter().any(|p| p.name == own.name) || model.fixed.contains_key(own.name);
            if let Some(prior) = own.prior.filter(|_| !said) {
                let usual = ParsedPrior::usual(own, prior).map_err(|e| in_job(e.to_string()))?;
                parameters.push(usual);
            }
        }
        for (name, &value) in &job.reference {
            shared::model::lookup(name, &scope)
                .and_then(|quantity| Ok(parameters::check_value(&quantity, name, value)?))
                .map_err(|e| in_job(format!("[figures] reference: {e}")))?;
        }
        add_unsaid(job_name, &effects, &wheels, &mut model, &mut parameters)?;
        let (fit_runs, holdout_runs): (Vec<usize>, Vec<usize>) =
            (0..experiment.runs.len()).partition(|&i| experiment.runs[i].usage == RunUse::Fit);
        bevameter
            .add_transfer(&model.fixed, &mut parameters)
            .map_err(|e| in_job(e.to_string()))?;
        noise::add_unknown_sds(&experiment, &bevameter, &mut parameters);
        noise::check_names(&experiment, &bevameter, &parameters).map_err(|e| in_job(e.to_string()))?;
        if joint_prior.is_some() {
            joint(&joint_prior, &parameters).map_err(|e| in_job(format!("[priors] posterior: {e}")))?;
        }
        let scatters = SoilScatter::all(&experiment, &fit_runs, &parameters).map_err(in_data)?;
        let likelihood = likelihood(
            &experiment,
            &fit_runs,
            &bevameter,
            &parameters,
            &scatters,
            job.likelihood,
        )
        .map_err(in_data)?;
        if parameters.is_empty() {
            return Err(in_job(
                "[priors] leaves no parameter free: there is nothing to calibrate".into(),
            ));
        }
        for algorithm in std::iter::once(&job.algorithm).chain(&job.point_estimates) {
            algorithm
                .check(parameters.len())
                .map_err(|e| in_job(format!("[sampler] {e}")))?;
        }
        let model_parameters: Vec<String> = parameters
            .iter()
            .filter(|p| !p.name.starts_with(parameters::NOISE_PREFIX))
            .map(|p| p.name.clone())
            .collect();
        if let Some(external) = &external {
            outside_model::check(external, &experiment, &fit_runs, &likelihood).map_err(in_job)?;
        }
        let medians = |names: &[String]| {
            let free = parameters.iter().filter(|p| names.contains(&p.name));
            free.map(|p| p.marginal.quantile(0.5)).collect::<Vec<f64>>()
        };
        let probe = external.as_ref().map(|_| medians(&model_parameters));
        let variant = |runs: &[usize]| {
            let runs = runs.iter().map(|&i| &experiment.runs[i]);
            let mut variant =
                ModelVariant::new(&experiment, &model, &effects, model_parameters.clone(), runs)
                    .map_err(|e| in_job(e.to_string()))?;
            variant.probe = probe.clone().unwrap_or_default();
            let mut sensitive = likelihood.sensitive().iter();
            variant.stiffness_sensitivity = sensitive.any(|own| own.derivative == BY_STIFFNESS);
            Ok(variant)
        };
        let mut fit_variant = variant(&fit_runs)?;
        let readings = experiment.plates.len() + experiment.shear.len();
        if readings > 0 && !model.kind.has_soil_laws() {
            return Err(in_job(format!(
                "kind = \"{}\" predicts no plates and rings: leave plates and shear out of the experiment",
                model.kind.name()
            )));
        }
        bevameter.ask(&mut fit_variant);
        let radius = |&i: &usize| experiment.wheels[&experiment.runs[i].wheel].radius_m;
        let radii_m: Vec<f64> = fit_runs.iter().map(radius).collect();
        let predicted = predicted_values(&likelihood, &radii_m);
        if let AlgorithmSettings::Sample(settings) = &job.algorithm {
            let (particles, values) = (settings.particles, predicted.len());
            if particles.saturating_mul(values) > MOST_NUMBERS {
                return Err(in_job(format!(
                    "[sampler] {particles} particles of {values} fitted values each are {} numbers; they must be at most {MOST_NUMBERS}",
                    particles.saturating_mul(values)
                )));
            }
        }
        if job.algorithm.has_metamodel() {
            if model.kind != ModelKind::Scm {
                return Err(in_job(
                    "metamodel_moves under [sampler]: the metamodel is made of quasi_static, and needs kind = \"scm\" to save runs of"
                        .into(),
                ));
            }
            let coarse = fit_variant.coarse();
            coarse.map_err(|e| in_job(format!("metamodel_moves under [sampler]: {e}")))?;
            fit_variant.companion = Some(Companion {
                values: predicted.clone(),
                metamodel: None,
            });
        }
        let holdout_variant = match holdout_runs.as_slice() {
            [] => None,
            runs => Some(variant(runs)?),
        };
        Ok(Spec {
            experiment,
            model,
            parameters,
            joint_prior,
            algorithm: job.algorithm,
            point_estimates: job.point_estimates,
            fit_runs,
            holdout_runs,
            fit_variant,
            holdout_variant,
            likelihood,
            scatters,
            predicted,
            reference: job.reference,
            likelihood_settings: job.likelihood,
            bevameter,
            discovery: job.discovery,
            accepted: job.accepted,
            models: job.models,
        })
    }

    /// The specifications of every model that a job compares, in the order of the job.
    ///
    /// # Errors
    /// As those of [`Spec::new`]; what a model gets wrong as a whole has the line of its `[[models]]`.
    pub fn of_models(
        job_name: &str,
        models: JobModels,
        texts: &BTreeMap<String, String>,
        experiment_name: &str,
        files: &FileSet,
    ) -> Result<Vec<Spec>, FileError> {
        let spec = |job: JobFile| {
            let (line, kind) = (job.line, job.model.kind.name());
            let spec = Spec::of(job_name, job, texts, experiment_name, files);
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

    /// What workers evaluate while sampling: the fitted runs, and of them the channels that the likelihood takes.
    pub fn sampled_variant(&self) -> ModelVariant {
        let fitted: BTreeSet<_> = self
            .predicted
            .iter()
            .filter_map(|value| value.channel())
            .collect();
        ModelVariant {
            channels: fitted.into_iter().collect(),
            ..self.fit_variant.clone()
        }
    }

    /// The predicted values that the likelihood takes, of an evaluation of the fitted runs.
    pub fn predicted_values(&self, observables: &Observables) -> Vec<f64> {
        self.predicted.iter().map(|value| value.of(observables)).collect()
    }

    /// Number of preparations of the soil that the fitted runs name; those without an id count each.
    pub fn preparations(&self) -> usize {
        noise::preparations(&self.experiment, &self.fit_runs).len()
    }

    /// The measurements of wheels that are fitted.
    pub fn wheel_data(&self) -> usize {
        self.likelihood
            .data()
            .iter()
            .filter(|d| d.channel < PLATE)
            .count()
    }

    /// Whether another specification means the same calibration; comments, the order of keys and what is accepted do not count.
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

    /// The joint prior, in parameter order.
    pub fn prior(&self) -> Prior {
        joint(&self.joint_prior, &self.parameters).expect("checked when the specification was made")
    }

    /// The part of a parameter vector that the model takes: everything but the noise sds.
    ///
    /// Noise parameters stand behind the model's, so this is a prefix.
    pub fn model_theta<'a>(&self, theta: &'a [f64]) -> &'a [f64] {
        &theta[..self.fit_variant.parameters.len()]
    }
}

/// The prior of parameters, of which the first may be jointly normal.
fn joint(joint: &Option<JointPrior>, parameters: &[FreeParameter]) -> Result<Prior, PriorError> {
    let prior = Prior::new(parameters.iter().map(|p| p.marginal.clone()).collect());
    match joint {
        None => Ok(prior),
        Some(joint) => prior.correlated((0..joint.parameters.len()).collect(), &joint.correlations),
    }
}

/// Adds what a job does not say of its effects: the number or the prior that the effect's file has.
fn add_unsaid(
    job_name: &str,
    effects: &EffectSet,
    wheels: &BTreeSet<&str>,
    model: &mut ModelSettings,
    parameters: &mut Vec<FreeParameter>,
) -> Result<(), FileError> {
    let free = parameters.iter().map(|p| p.name.clone());
    let said: Vec<String> = free.chain(model.fixed.keys().cloned()).collect();
    let said = said.iter().map(String::as_str).collect();
    for unsaid in effects.unsaid(&said, wheels) {
        let parsed = ParsedPrior::of_effect(&unsaid.name, unsaid.parameter).map_err(|e| {
            match &unsaid.chosen.file {
                Some(file) => FileError::at(file, unsaid.parameter.line, e.to_string()),
                None => FileError::whole(job_name, format!("effect {}: {e}", unsaid.chosen.effect.name)),
            }
        })?;
        match parsed {
            ParsedPrior::Fixed(value) => {
                model.fixed.insert(unsaid.name.clone(), value);
            }
            ParsedPrior::Free(parameter) => parameters.push(parameter),
        }
    }
    Ok(())
}
