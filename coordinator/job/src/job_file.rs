//! The tables of `job.toml`.

use std::collections::BTreeMap;

use serde::Deserialize;
use shared::file::{FileError, parse_toml, unknown_word};
use shared::model::ModelSettings;

use crate::plausibility::question::Question;
use crate::table::algorithm_settings::AlgorithmSettings;
use crate::table::discovery_settings::{Apply, DiscoverySettings, RawDiscovery};
use crate::table::likelihood_settings::{LikelihoodSettings, RawLikelihood};
use crate::table::model_entry::{ModelEntry, model_entries};
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
    /// Which forward model, with its fixed parameters; of several that are compared, this one.
    pub model: ModelSettings,
    /// How many models the job compares; 1 where it has a table `[model]`.
    pub models: usize,
    /// Line of its `[[models]]`; `None` of a table `[model]`.
    pub line: Option<usize>,
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
    /// Effect files of the other models.
    also_named: Vec<String>,
}

/// A job as written, once for each model that it compares.
#[derive(Debug)]
pub struct JobModels {
    /// The first model, or the only one.
    pub first: JobFile,
    /// The others, in the order of the file.
    pub others: Vec<JobFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawJob {
    experiment: Option<String>,
    #[serde(default)]
    accept: Vec<String>,
    model: Option<toml::Table>,
    #[serde(default)]
    models: Vec<toml::Table>,
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

impl JobModels {
    /// Answers a question, for every model.
    ///
    /// # Errors
    /// No question has this name; the sentence has the nearest.
    pub fn accept(&mut self, name: &str) -> Result<(), String> {
        Question::check_name(name)?;
        for job in std::iter::once(&mut self.first).chain(&mut self.others) {
            job.accepted.push(name.to_owned());
        }
        Ok(())
    }
}

impl JobFile {
    /// Parses a job file; `name` is how messages call it.
    ///
    /// # Errors
    /// [`FileError`] with the line, or with the table and key.
    pub fn parse(name: &str, toml: &str) -> Result<JobFile, FileError> {
        Ok(JobFile::parse_models(name, toml)?.first)
    }

    /// The same with the other models that it compares.
    ///
    /// # Errors
    /// As those of [`JobFile::parse`]; of a model with its line.
    pub fn parse_models(name: &str, toml: &str) -> Result<JobModels, FileError> {
        let mut raw: RawJob = parse_toml(name, toml)?;
        let fail = |message: String| FileError::whole(name, message);
        for name in &raw.accept {
            Question::check_name(name).map_err(fail)?;
        }
        let likelihood = raw
            .likelihood
            .settings()
            .map_err(|e| fail(format!("[likelihood] {e}")))?;
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
        let (first, others) = model_entries(name, toml, raw.model, raw.models, raw.priors)?;
        let models = 1 + others.len();
        if models > 1 {
            check_comparison(&algorithm, &point_estimates, posterior.is_some()).map_err(&fail)?;
        }
        let also_named: Vec<String> = others
            .iter()
            .flat_map(|other| other.settings.effect_files.iter().cloned())
            .collect();
        let job = |entry: ModelEntry| JobFile {
            experiment: raw.experiment.clone(),
            accepted: raw.accept.clone(),
            model: entry.settings,
            models,
            line: entry.line,
            priors: entry.priors,
            posterior: posterior.clone(),
            algorithm,
            point_estimates: point_estimates.clone(),
            reference: raw.figures.reference.clone(),
            likelihood,
            discovery,
            also_named: also_named.clone(),
        };
        Ok(JobModels {
            first: job(first),
            others: others.into_iter().map(job).collect(),
        })
    }

    /// The search for missing effects of this job's model: it draws with the job's seed, and asks for nothing besides.
    pub fn into_search(self) -> JobFile {
        JobFile {
            algorithm: AlgorithmSettings::Discover {
                seed: self.algorithm.seed(),
            },
            point_estimates: Vec::new(),
            discovery: DiscoverySettings {
                apply: Apply::Off,
                ..self.discovery
            },
            ..self
        }
    }

    /// The files that the job names beside its experiment.
    pub fn named_files(&self) -> Vec<String> {
        let posterior = self.posterior.as_ref().map(|p| p.file.clone());
        let own = self.model.effect_files.iter();
        let mut named: Vec<String> = own.chain(&self.also_named).cloned().chain(posterior).collect();
        named.sort();
        named.dedup();
        named
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

/// What a comparison of models asks of the rest of the job, a sentence where it is not there.
fn check_comparison(
    algorithm: &AlgorithmSettings,
    point_estimates: &[AlgorithmSettings],
    has_posterior_prior: bool,
) -> Result<(), String> {
    if !algorithm.has_posterior() {
        return Err(format!(
            "[sampler] algorithm = \"{}\" has no evidence, by which [[models]] are compared; tmcmc has",
            algorithm.name()
        ));
    }
    if !point_estimates.is_empty() {
        return Err("[sampler] point_estimates belong to a job with one [model], not to [[models]]".into());
    }
    if has_posterior_prior {
        return Err("[priors] posterior belongs to a job with one [model], not to [[models]]".into());
    }
    Ok(())
}
