//! The tables of `job.toml`.

use std::collections::BTreeMap;

use inference::{Algorithm, Settings};
use serde::Deserialize;
use shared::file::{FileError, parse_toml, unknown_word};
use shared::model::ModelSettings;

use super::priors::PriorEntry;

/// A job as written, before it meets its experiment.
#[derive(Debug)]
pub struct Job {
    /// Name of the experiment's file, relative to the job's; absent where a service holds the experiment.
    pub experiment: Option<String>,
    /// Which forward model, with its fixed parameters.
    pub model: ModelSettings,
    /// The priors in the order of the file.
    pub priors: Vec<PriorEntry>,
    /// Settings of the sampler.
    pub sampler: Settings,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawJob {
    experiment: Option<String>,
    model: toml::Table,
    #[serde(default)]
    priors: BTreeMap<String, toml::Spanned<toml::Value>>,
    #[serde(default)]
    sampler: RawSampler,
    #[serde(default)]
    discovery: RawDiscovery,
    #[serde(default)]
    likelihood: RawLikelihood,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct RawSampler {
    algorithm: String,
    particles: usize,
    moves: [usize; 2],
    seed: u64,
}

impl Default for RawSampler {
    fn default() -> Self {
        RawSampler {
            algorithm: "tmcmc".into(),
            particles: 1000,
            moves: [10, 60],
            seed: 1,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct RawDiscovery {
    apply: String,
    max_effects: u32,
}

impl Default for RawDiscovery {
    fn default() -> Self {
        RawDiscovery {
            apply: "off".into(),
            max_effects: 3,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct RawLikelihood {
    kind: String,
    discrepancy: toml::Value,
}

impl Default for RawLikelihood {
    fn default() -> Self {
        RawLikelihood {
            kind: "gaussian".into(),
            discrepancy: toml::Value::Float(0.0),
        }
    }
}

const LATER: &str = "is not available in this version";

impl Job {
    /// Parses a job file; `name` is how messages call it.
    ///
    /// # Errors
    /// [`FileError`] with the line, or with the table and key.
    pub fn parse(name: &str, toml: &str) -> Result<Job, FileError> {
        let raw: RawJob = parse_toml(name, toml)?;
        let fail = |message: String| FileError::whole(name, message);
        raw.discovery
            .check()
            .map_err(|e| fail(format!("[discovery] {e}")))?;
        raw.likelihood
            .check()
            .map_err(|e| fail(format!("[likelihood] {e}")))?;
        let model = ModelSettings::from_table(&raw.model).map_err(|e| fail(format!("[model] {e}")))?;
        let sampler = raw
            .sampler
            .settings()
            .map_err(|e| fail(format!("[sampler] {e}")))?;
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
        Ok(Job {
            experiment: raw.experiment,
            model,
            priors,
            sampler,
        })
    }
}

impl RawSampler {
    fn settings(self) -> Result<Settings, String> {
        let algorithm = match self.algorithm.as_str() {
            "tmcmc" => Algorithm::Tmcmc,
            "ching-chen-2007" => Algorithm::ChingChen2007,
            later @ ("basis" | "ga" | "cma-es" | "lm") => {
                return Err(format!("algorithm = \"{later}\" {LATER}"));
            }
            other => return Err(unknown_word("algorithm", other, ["tmcmc", "ching-chen-2007"])),
        };
        Ok(Settings {
            algorithm,
            particles: self.particles,
            moves: self.moves,
            seed: self.seed,
            ..Settings::default()
        })
    }
}

impl RawDiscovery {
    fn check(&self) -> Result<(), String> {
        match self.apply.as_str() {
            "off" if self.max_effects <= 10 => Ok(()),
            "off" => Err(format!("max_effects = {} must be at most 10", self.max_effects)),
            later @ ("ask" | "auto") => Err(format!("apply = \"{later}\" {LATER}")),
            other => Err(unknown_word("value of apply", other, ["off", "ask", "auto"])),
        }
    }
}

impl RawLikelihood {
    fn check(&self) -> Result<(), String> {
        match self.kind.as_str() {
            "gaussian" => {}
            "student_t" => return Err(format!("kind = \"student_t\" {LATER}")),
            other => return Err(unknown_word("kind", other, ["gaussian", "student_t"])),
        }
        let none = self
            .discrepancy
            .as_float()
            .or(self.discrepancy.as_integer().map(|i| i as f64));
        match none {
            Some(zero) if zero.abs() == 0.0 => Ok(()),
            _ => Err(format!("discrepancy = {} {LATER}; 0.0 is", self.discrepancy)),
        }
    }
}
