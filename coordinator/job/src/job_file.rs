//! The tables of `job.toml`.

use std::collections::BTreeMap;

use serde::Deserialize;
use shared::file::{FileError, parse_toml, unknown_word};
use shared::model::ModelSettings;

use crate::plausibility::question::Question;
use crate::table::algorithm_settings::AlgorithmSettings;
use crate::table::discovery_settings::{DiscoverySettings, RawDiscovery};
use crate::table::likelihood_settings::{LikelihoodSettings, RawLikelihood};
use crate::table::posterior_prior::PosteriorPrior;
use crate::table::prior_entry::PriorEntry;
use crate::table::sampler_table::RawSampler;

/// A job as written, before it meets its experiment.
#[derive(Debug)]
pub struct JobFile {
    /// Name of the experiment's file, relative to the job's; absent where a service holds the experiment.
    pub experiment: Option<String>,
    /// Names of the questions that are answered: what looks odd, and is meant.
    pub accepted: Vec<String>,
    /// Which forward model, with its fixed parameters.
    pub model: ModelSettings,
    /// The priors in the order of the file.
    pub priors: Vec<PriorEntry>,
    /// The posterior that is the prior of what the entries leave unsaid.
    pub posterior: Option<PosteriorPrior>,
    /// The algorithm with its settings.
    pub algorithm: AlgorithmSettings,
    /// The fits and searches that stand beside the sample in its study.
    pub point_estimates: Vec<AlgorithmSettings>,
    /// What an independent test says of parameters, for the figures alone: name and value.
    pub reference: BTreeMap<String, f64>,
    /// How measurements scatter around the model.
    pub likelihood: LikelihoodSettings,
    /// Whether its study looks for missing effects.
    pub discovery: DiscoverySettings,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawJob {
    experiment: Option<String>,
    #[serde(default)]
    accept: Vec<String>,
    model: toml::Table,
    #[serde(default)]
    priors: BTreeMap<String, toml::Spanned<toml::Value>>,
    #[serde(default)]
    sampler: RawSampler,
    #[serde(default)]
    discovery: RawDiscovery,
    #[serde(default)]
    likelihood: RawLikelihood,
    #[serde(default)]
    figures: RawFigures,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct RawFigures {
    reference: BTreeMap<String, f64>,
}

impl JobFile {
    /// Parses a job file; `name` is how messages call it.
    ///
    /// # Errors
    /// [`FileError`] with the line, or with the table and key.
    pub fn parse(name: &str, toml: &str) -> Result<JobFile, FileError> {
        let mut raw: RawJob = parse_toml(name, toml)?;
        let fail = |message: String| FileError::whole(name, message);
        for name in &raw.accept {
            Question::check_name(name).map_err(fail)?;
        }
        let likelihood = raw
            .likelihood
            .settings()
            .map_err(|e| fail(format!("[likelihood] {e}")))?;
        let model = ModelSettings::from_table(&raw.model).map_err(|e| fail(format!("[model] {e}")))?;
        let algorithm = raw
            .sampler
            .algorithm()
            .map_err(|e| fail(format!("[sampler] {e}")))?;
        let point_estimates = raw.sampler.point_estimates(algorithm.seed());
        let point_estimates = point_estimates.map_err(|e| fail(format!("[sampler] {e}")))?;
        let discovery = raw
            .discovery
            .settings(&algorithm)
            .map_err(|e| fail(format!("[discovery] {e}")))?;
        let posterior = PosteriorPrior::take(|key| raw.priors.remove(key).map(toml::Spanned::into_inner))
            .map_err(|e| fail(format!("[priors] {e}")))?;
        let mut priors: Vec<_> = raw.priors.into_iter().collect();
        priors.sort_by_key(|(_, value)| value.span().start);
        let priors = priors
            .into_iter()
            .map(|(key, value)| {
                let line = toml[..value.span().start].matches('\n').count() + 1;
                PriorEntry {
                    name: key,
                    line,
                    value: value.into_inner(),
                }
            })
            .collect();
        Ok(JobFile {
            experiment: raw.experiment,
            accepted: raw.accept,
            model,
            priors,
            posterior,
            algorithm,
            point_estimates,
            reference: raw.figures.reference,
            likelihood,
            discovery,
        })
    }

    /// Answers a question.
    ///
    /// # Errors
    /// No question has this name; the sentence has the nearest.
    pub fn accept(&mut self, name: &str) -> Result<(), String> {
        Question::check_name(name)?;
        self.accepted.push(name.to_owned());
        Ok(())
    }

    /// The files that the job names beside its experiment.
    pub fn named_files(&self) -> Vec<String> {
        let posterior = self.posterior.as_ref().map(|p| p.file.clone());
        self.model.effect_files.iter().cloned().chain(posterior).collect()
    }

    /// Checks that no file came along that the job does not name; `name` is how messages call it.
    ///
    /// # Errors
    /// [`FileError`] with the file that is not named, and the nearest that is.
    pub fn check_files(&self, name: &str, texts: &BTreeMap<String, String>) -> Result<(), FileError> {
        let named = self.named_files();
        match texts.keys().find(|file| !named.contains(file)) {
            None => Ok(()),
            Some(file) => {
                let message = unknown_word("file", file, named.iter().map(String::as_str));
                Err(FileError::whole(name, message))
            }
        }
    }
}
