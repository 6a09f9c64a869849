//! A job as users write it: the tables of `job.toml` as values.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use shared::file::{FileError, FileSet, TomlFile, unknown_word};
use shared::model::{ModelError, ModelSettings};

use crate::decision::{Decision, RawDecision};
use crate::named_files::NamedFiles;
use crate::plausibility::question::Question;
use crate::table::algorithm_settings::AlgorithmSettings;
use crate::table::candidate_priors;
use crate::table::discovery_settings::{Apply, DiscoverySettings, RawDiscovery};
use crate::table::likelihood_settings::{LikelihoodSettings, RawLikelihood};
use crate::table::model_entry::{COMPARED, ModelEntry, model_entries};
use crate::table::posterior_prior::PosteriorPrior;
use crate::table::prior_entry::PriorEntry;
use crate::table::sampler::SamplerTable;

/// A job as users write it, without its experiment. Candidates of a search are changes of this value ([`Job::with`]).
#[derive(Debug, Clone)]
pub struct Job {
    /// Name of the experiment's file, relative to the job's; absent if a service holds the experiment.
    pub experiment: Option<String>,
    /// Names of the plausibility questions whose odd values are intended.
    pub accepted: Vec<String>,
    /// The forward model with its fixed parameters; of several that are compared, this one.
    pub model: ModelSettings,
    /// The table that the model was read from.
    pub(crate) table: toml::Table,
    /// Number of models that the job compares; 1 if it has a table `[model]`.
    pub models: usize,
    /// Line of its `[[models]]`; `None` for a table `[model]`.
    pub line: Option<usize>,
    /// The priors in the order of the file.
    pub priors: Vec<PriorEntry>,
    /// The posterior of another calibration, which is the prior of parameters that no entry states.
    pub posterior: Option<PosteriorPrior>,
    /// The algorithm with its settings.
    pub algorithm: AlgorithmSettings,
    /// Whether the kind of the model decides how a stage gets its particles.
    stages_follow_kind: bool,
    /// The fits and searches that stand beside the sample in its study.
    pub point_estimates: Vec<AlgorithmSettings>,
    /// Values of parameters by independent tests, by name. The figures alone show them.
    pub reference: BTreeMap<String, f64>,
    /// The scatter of measurements around the model.
    pub likelihood: LikelihoodSettings,
    /// The search of its study for missing effects.
    pub discovery: DiscoverySettings,
    /// The decision that the posterior is for, if the job states one.
    pub decision: Option<Decision>,
    /// Priors of candidates of a search, by the full names of their parameters: `[discovery.priors]`.
    pub candidate_priors: BTreeMap<String, toml::Value>,
    /// Names of the files whose effects a search tries beside the catalogue: `[discovery] candidate_files`.
    pub candidate_files: Vec<String>,
    /// The texts of the files that the job names; empty until [`Job::beside`] gives them.
    pub files: NamedFiles,
    /// Effect files of the other models.
    also_named: Vec<String>,
}

/// A job as written, once for each model that it compares.
#[derive(Debug)]
pub struct JobModels {
    /// The first model, or the only one.
    pub first: Job,
    /// The others, in the order of the file.
    pub others: Vec<Job>,
}

/// A calibration.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["model"] }, { "required": ["models"] }]))]
pub(crate) struct RawJob {
    /// File of the experiment, beside the job.
    experiment: Option<String>,
    /// Names of the plausibility questions whose odd values are intended.
    #[serde(default)]
    #[schemars(extend("uniqueItems" = true, "items" = { "type": "string", "enum": Question::names() }))]
    accept: Vec<String>,
    #[schemars(with = "Option<Value>")]
    model: Option<toml::Table>,
    /// Several models to compare, in place of `[model]`.
    #[serde(default)]
    #[schemars(with = "Vec<Value>", length(min = *COMPARED.start(), max = *COMPARED.end()))]
    models: Vec<toml::Table>,
    #[serde(default)]
    #[schemars(with = "Value")]
    priors: BTreeMap<String, toml::Spanned<toml::Value>>,
    // It is read by the struct of its algorithm.
    #[serde(default, rename = "sampler")]
    #[schemars(with = "Value")]
    _sampler: IgnoredAny,
    #[serde(default)]
    discovery: RawDiscovery,
    #[serde(default)]
    likelihood: RawLikelihood,
    #[serde(default)]
    figures: RawFigures,
    decision: Option<RawDecision>,
}

/// The figures of a report.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct RawFigures {
    /// Values of parameters by independent tests.
    reference: BTreeMap<String, f64>,
}

impl JobModels {
    /// Accepts the odd values of a question, for every model.
    ///
    /// # Errors
    /// The sentence names the nearest question if none has this name.
    pub fn accept(&mut self, name: &str) -> Result<(), String> {
        Question::check_name(name)?;
        for job in std::iter::once(&mut self.first).chain(&mut self.others) {
            job.accepted.push(name.to_owned());
        }
        Ok(())
    }
}

impl Job {
    /// Parses a job; messages call it `name`.
    ///
    /// # Errors
    /// [`FileError`] with the line, or with the table and key.
    pub fn parse(name: &str, toml: &str) -> Result<Job, FileError> {
        Ok(Job::parse_models(name, toml)?.first)
    }

    /// Parses a job together with the files that it names.
    ///
    /// # Errors
    /// The errors of [`Job::parse`].
    pub fn read(name: &str, files: &FileSet) -> Result<Job, FileError> {
        Ok(Job::parse(name, &files.toml)?.beside(NamedFiles::from(&files.files)))
    }

    /// Parses a job with every model that it compares.
    ///
    /// # Errors
    /// The errors of [`Job::parse`]; an error of a model has its line.
    pub fn parse_models(name: &str, toml: &str) -> Result<JobModels, FileError> {
        let file = TomlFile::parse(name, toml)?;
        let sampler = SamplerTable::read(&file)?;
        let mut raw: RawJob = file.read_all()?;
        let fail = |message: String| FileError::whole(name, message);
        for name in &raw.accept {
            Question::check_name(name).map_err(fail)?;
        }
        let likelihood = raw.likelihood.settings();
        let likelihood = likelihood.map_err(|e| fail(format!("[likelihood] {e}")))?;
        let discovery = raw.discovery.settings(&sampler.algorithm);
        let discovery = discovery.map_err(|e| fail(format!("[discovery] {e}")))?;
        let decision = raw.decision.take().map(RawDecision::decision).transpose();
        let decision = decision.map_err(|e| fail(format!("[decision] {e}")))?;
        let posterior = PosteriorPrior::take(|key| raw.priors.remove(key).map(toml::Spanned::into_inner))
            .map_err(|e| fail(format!("[priors] {e}")))?;
        let (first, others) = model_entries(name, toml, raw.model, raw.models, raw.priors)?;
        let models = 1 + others.len();
        if models > 1 {
            check_comparison(&sampler, posterior.is_some()).map_err(&fail)?;
        }
        let kinds = std::iter::once(&first)
            .chain(&others)
            .map(|entry| entry.settings.kind);
        let batch = sampler.check_batch(kinds);
        batch.map_err(|e| fail(format!("[sampler] {e}")))?;
        let also_named = others.iter().flat_map(|other| &other.settings.effect_files);
        let first = Job {
            experiment: raw.experiment,
            accepted: raw.accept,
            stages_follow_kind: sampler.follows_kind,
            algorithm: sampler.algorithm_for(first.settings.kind),
            model: first.settings,
            table: first.table,
            models,
            line: first.line,
            priors: first.priors,
            posterior,
            point_estimates: sampler.point_estimates.clone(),
            reference: raw.figures.reference,
            likelihood,
            discovery,
            decision,
            candidate_priors: candidate_priors::by_name(&raw.discovery.priors),
            candidate_files: raw.discovery.candidate_files,
            files: NamedFiles::default(),
            also_named: also_named.cloned().collect(),
        };
        let other = |entry: ModelEntry| Job {
            algorithm: sampler.algorithm_for(entry.settings.kind),
            model: entry.settings,
            table: entry.table,
            line: entry.line,
            priors: entry.priors,
            ..first.clone()
        };
        let others = others.into_iter().map(other).collect();
        Ok(JobModels { first, others })
    }

    /// Returns the job with the files that it names.
    pub fn beside(self, files: NamedFiles) -> Job {
        Job { files, ..self }
    }

    /// Lists further effects of the catalogue and effect files under `[model]`.
    ///
    /// # Errors
    /// [`ModelError`] names the effect that is unknown or listed already, or the number of effects.
    pub fn list_effects(&mut self, effects: &[String], files: &[String]) -> Result<(), ModelError> {
        self.model.add_effects(effects, files)?;
        self.list("effects", effects.iter());
        self.list("effect_files", files.iter());
        Ok(())
    }

    /// Reads the model's table again after a change.
    pub(crate) fn read_model(&mut self) -> Result<(), String> {
        let model = ModelSettings::from_table(&self.table);
        self.model = model.map_err(|e| format!("[model] {e}"))?;
        if self.stages_follow_kind {
            self.algorithm = self.algorithm.with_stages_for(self.model.kind);
        }
        Ok(())
    }

    /// Returns the search for missing effects of this job's model, with the job's seed and without point estimates.
    pub fn into_search(self) -> Job {
        Job {
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

    /// Returns the files that the job names beside its experiment.
    pub fn named_files(&self) -> Vec<String> {
        let posterior = self.posterior.as_ref().map(|p| p.file.clone());
        let effect_files = self.model.effect_files.iter();
        let mut named: Vec<String> = effect_files
            .chain(&self.also_named)
            .chain(&self.candidate_files)
            .cloned()
            .chain(posterior)
            .collect();
        named.sort();
        named.dedup();
        named
    }

    /// Checks that the job names every file that was sent; messages call it `name`.
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

/// Checks the rest of a job that compares models; the sentence says what is missing.
fn check_comparison(sampler: &SamplerTable, has_posterior_prior: bool) -> Result<(), String> {
    if !sampler.algorithm.has_posterior() {
        return Err(format!(
            "[sampler] algorithm = \"{}\" has no evidence, by which [[models]] are compared; tmcmc has",
            sampler.algorithm.name()
        ));
    }
    if !sampler.point_estimates.is_empty() {
        return Err("[sampler] point_estimates belong to a job with one [model], not to [[models]]".into());
    }
    if has_posterior_prior {
        return Err("[priors] posterior belongs to a job with one [model], not to [[models]]".into());
    }
    Ok(())
}
