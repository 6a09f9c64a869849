//! The fixed and the free parameters of a calibration, with their priors.

use std::collections::BTreeSet;

use shared::experiment::Experiment;
use shared::file::{FileError, number};
use shared::model::{EffectSet, ModelSettings, ParameterScope};
use shared::parameters::{self, NOISE_PREFIX, RING_TRANSFER};
use statistics::{Prior, PriorError};

use crate::data::bevameter_readings::BevameterReadings;
use crate::data::noise;
use crate::data::shared_sd::{SharedSd, StiffnessErrors};
use crate::data::transient_readings::TransientReadings;
use crate::job::Job;
use crate::table::posterior_prior::JointPrior;
use crate::table::prior_entry::{FreeParameter, ParsedPrior, check_candidate};

/// The model with its fixed parameters, and the free parameters.
pub(super) struct Parameters {
    pub(super) model: ModelSettings,
    pub(super) effects: EffectSet,
    /// The free parameters with their priors, in the order of every parameter vector.
    pub(super) free: Vec<FreeParameter>,
    /// The posterior of another calibration that is the prior of the first parameters, if the job states one.
    pub(super) joint_prior: Option<JointPrior>,
}

impl Parameters {
    /// Returns the parameters in their order: those of a posterior, those that the job states, then those that the model, its effects,
    /// the rings and the noise add.
    pub(super) fn new(
        name: &str,
        job: &Job,
        experiment: &Experiment,
        (bevameter, transients): (&BevameterReadings, &TransientReadings),
        stiffness: StiffnessErrors,
    ) -> Result<Parameters, FileError> {
        let in_job = |message: String| FileError::whole(name, message);
        let wheels = experiment.wheel_names();
        check_candidates(name, job)?;
        let effects = effects(name, job)?;
        let scope = ParameterScope {
            wheels: &wheels,
            effects: &effects,
            external: job.model.external.as_ref(),
        };
        let (joint_prior, mut free) = posterior_parameters(name, job, &scope)?;
        let mut model = job.model.clone();
        add_stated(name, job, &scope, &mut model, &mut free)?;
        for parameter in model.kind.parameters() {
            let is_stated =
                free.iter().any(|p| p.name == parameter.name) || model.fixed.contains_key(parameter.name);
            if let Some(usual) = ParsedPrior::usual(parameter).filter(|_| !is_stated) {
                free.push(usual.map_err(|e| in_job(e.to_string()))?);
            }
        }
        check_reference(job, &scope).map_err(in_job)?;
        add_unstated(name, &effects, &wheels, &mut model, &mut free)?;
        bevameter
            .add_transfer(&model.fixed, &mut free)
            .map_err(|e| in_job(e.to_string()))?;
        transients
            .add_parameters(&mut free)
            .map_err(|e| in_job(e.to_string()))?;
        let shared = SharedSd::all(experiment, bevameter, stiffness);
        noise::add_unknown_sds(experiment, &shared, &mut free);
        noise::check_names(experiment, &shared, &free).map_err(|e| in_job(e.to_string()))?;
        if joint_prior.is_some() {
            joint(&joint_prior, &free).map_err(|e| in_job(format!("[priors] posterior: {e}")))?;
        }
        Ok(Parameters {
            model,
            effects,
            free,
            joint_prior,
        })
    }
}

/// Returns the effects that the job lists, and those whose parameters it names.
fn effects(name: &str, job: &Job) -> Result<EffectSet, FileError> {
    let named = job.priors.iter().map(|entry| entry.name.as_str());
    let named = named.filter(|name| !name.starts_with(NOISE_PREFIX));
    let names = named.chain(job.model.fixed.keys().map(String::as_str));
    EffectSet::choose(
        name,
        (&job.model.effects, &job.model.effect_files),
        names.filter(|name| *name != RING_TRANSFER),
        |file| job.files.effect(file),
    )
}

/// Checks the files of the search's candidates.
fn check_candidates(name: &str, job: &Job) -> Result<(), FileError> {
    let mut names = BTreeSet::new();
    for file in &job.candidate_files {
        let effect = job.files.effect(file).unwrap_or_else(|| {
            let message = format!("file \"{file}\" is named but was not sent");
            Err(FileError::whole(name, message))
        })?;
        check_candidate(file, &effect)?;
        if !names.insert(effect.name.clone()) {
            let message = format!(
                "[discovery] candidate_files has two files of the effect \"{}\"",
                effect.name
            );
            return Err(FileError::whole(name, message));
        }
    }
    Ok(())
}

/// Returns the parameters that have the posterior of another calibration as their prior.
fn posterior_parameters(
    name: &str,
    job: &Job,
    scope: &ParameterScope,
) -> Result<(Option<JointPrior>, Vec<FreeParameter>), FileError> {
    let Some(posterior) = job.posterior.clone() else {
        return Ok((None, Vec::new()));
    };
    let text = job.files.text(&posterior.file).ok_or_else(|| {
        let message = format!("file \"{}\" is named but was not sent", posterior.file);
        FileError::whole(name, message)
    })?;
    let entry = |name: &str| job.priors.iter().find(|entry| entry.name == name);
    let fixed = |name: &str| {
        let stated = || entry(name).and_then(|entry| number(&entry.value));
        job.model.fixed.get(name).copied().or_else(stated)
    };
    let is_stated = |name: &str| entry(name).is_some() || job.model.fixed.contains_key(name);
    let (joint, covered) = posterior.fit(text, fixed, is_stated, scope)?;
    Ok((Some(joint), covered))
}

/// Adds the entries of the job under `[priors]`.
fn add_stated(
    name: &str,
    job: &Job,
    scope: &ParameterScope,
    model: &mut ModelSettings,
    free: &mut Vec<FreeParameter>,
) -> Result<(), FileError> {
    for entry in &job.priors {
        match entry.parse(scope).map_err(|e| entry.error(name, e.to_string()))? {
            ParsedPrior::Fixed(value) => {
                if model.fixed.insert(entry.name.clone(), value).is_some() {
                    let message = format!(
                        "{} is fixed under [model] and stands again under [priors]",
                        entry.name
                    );
                    return Err(entry.error(name, message));
                }
            }
            ParsedPrior::Free(parameter) => free.push(parameter),
        }
    }
    Ok(())
}

/// Checks the values of `[figures] reference`.
fn check_reference(job: &Job, scope: &ParameterScope) -> Result<(), String> {
    for (name, &value) in &job.reference {
        shared::model::lookup(name, scope)
            .and_then(|quantity| Ok(parameters::check_value(&quantity, name, value)?))
            .map_err(|e| format!("[figures] reference: {e}"))?;
    }
    Ok(())
}

/// Adds parameters of effects that the job does not state, with the number or the prior of the effect's file.
fn add_unstated(
    name: &str,
    effects: &EffectSet,
    wheels: &BTreeSet<&str>,
    model: &mut ModelSettings,
    parameters: &mut Vec<FreeParameter>,
) -> Result<(), FileError> {
    let free = parameters.iter().map(|p| p.name.clone());
    let stated: Vec<String> = free.chain(model.fixed.keys().cloned()).collect();
    let stated = stated.iter().map(String::as_str).collect();
    for unstated in effects.unstated_parameters(&stated, wheels) {
        let parsed =
            ParsedPrior::from_effect(&unstated.name, unstated.parameter).map_err(|e| {
                match &unstated.chosen.file {
                    Some(file) => FileError::at(file, unstated.parameter.line, e.to_string()),
                    None => FileError::whole(name, format!("effect {}: {e}", unstated.chosen.effect.name)),
                }
            })?;
        match parsed {
            ParsedPrior::Fixed(value) => {
                model.fixed.insert(unstated.name.clone(), value);
            }
            ParsedPrior::Free(parameter) => parameters.push(parameter),
        }
    }
    Ok(())
}

/// Returns the prior of the parameters, the first of which may be jointly normal.
pub(super) fn joint(joint: &Option<JointPrior>, parameters: &[FreeParameter]) -> Result<Prior, PriorError> {
    let prior = Prior::new(parameters.iter().map(|p| p.marginal.clone()).collect());
    match joint {
        None => Ok(prior),
        Some(joint) => prior.correlated((0..joint.parameters.len()).collect(), &joint.correlations),
    }
}
