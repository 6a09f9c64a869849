//! The table `[sampler]`: which algorithm, and its settings.

use inference::{Algorithm, lm};
use serde::Deserialize;
use shared::file::unknown_word;

use super::job_file::LATER;

/// How parameters are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// A sample of the posterior.
    Sample(inference::Settings),
    /// The most probable parameters.
    Fit(lm::Settings),
}

/// Settings that do not fit the prior.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MethodError {
    /// The sampler's.
    #[error(transparent)]
    Sample(#[from] inference::SettingsError),
    /// The fit's.
    #[error(transparent)]
    Fit(#[from] lm::SettingsError),
}

impl Method {
    /// The algorithm's name in files.
    pub fn name(&self) -> &'static str {
        match self {
            Method::Sample(settings) => match settings.algorithm {
                Algorithm::Tmcmc => "tmcmc",
                Algorithm::ChingChen2007 => "ching-chen-2007",
            },
            Method::Fit(_) => "lm",
        }
    }

    /// The algorithm with its size: `tmcmc with 1000 particles`.
    pub fn words(&self) -> String {
        let name = self.name();
        match self {
            Method::Sample(settings) => format!("{name} with {} particles", settings.particles),
            Method::Fit(settings) => format!("{name} with at most {} evaluations", settings.max_evaluations),
        }
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        match self {
            Method::Sample(settings) => settings.seed,
            Method::Fit(settings) => settings.seed,
        }
    }

    /// More proposals than this are in no round: evaluations are numbered by it.
    pub fn width(&self) -> usize {
        match self {
            Method::Sample(settings) => settings.particles,
            Method::Fit(settings) => settings.max_evaluations,
        }
    }

    /// Checks the settings for so many parameters.
    ///
    /// # Errors
    /// [`MethodError`] names the setting, its value and its bound.
    pub fn check(&self, dimension: usize) -> Result<(), MethodError> {
        match self {
            Method::Sample(settings) => settings.check(dimension)?,
            Method::Fit(settings) => settings.check(dimension)?,
        }
        Ok(())
    }
}

/// The table as written; every algorithm reads its own keys.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct RawSampler {
    algorithm: Option<String>,
    seed: Option<u64>,
    particles: Option<usize>,
    moves: Option<[usize; 2]>,
    starts: Option<usize>,
    max_evaluations: Option<usize>,
    difference_step: Option<f64>,
}

const AVAILABLE: [&str; 3] = ["tmcmc", "ching-chen-2007", "lm"];

impl RawSampler {
    pub(super) fn method(self) -> Result<Method, String> {
        let name = self.algorithm.as_deref().unwrap_or("tmcmc");
        match name {
            "tmcmc" => self.sample(Algorithm::Tmcmc),
            "ching-chen-2007" => self.sample(Algorithm::ChingChen2007),
            "lm" => self.fit(),
            later @ ("basis" | "ga" | "cma-es") => Err(format!("algorithm = \"{later}\" {LATER}")),
            other => Err(unknown_word("algorithm", other, AVAILABLE)),
        }
    }

    fn sample(&self, algorithm: Algorithm) -> Result<Method, String> {
        let foreign = [
            ("starts", self.starts.is_some()),
            ("max_evaluations", self.max_evaluations.is_some()),
            ("difference_step", self.difference_step.is_some()),
        ];
        let usual = inference::Settings::default();
        let method = Method::Sample(inference::Settings {
            algorithm,
            particles: self.particles.unwrap_or(usual.particles),
            moves: self.moves.unwrap_or(usual.moves),
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        });
        refuse(&foreign, "lm", &method, "particles, moves, seed")
    }

    fn fit(&self) -> Result<Method, String> {
        let foreign = [
            ("particles", self.particles.is_some()),
            ("moves", self.moves.is_some()),
        ];
        let usual = lm::Settings::default();
        let method = Method::Fit(lm::Settings {
            starts: self.starts.unwrap_or(usual.starts),
            max_evaluations: self.max_evaluations.unwrap_or(usual.max_evaluations),
            difference_step: self.difference_step.unwrap_or(usual.difference_step),
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        });
        let own = "starts, max_evaluations, difference_step, seed";
        refuse(&foreign, "tmcmc and ching-chen-2007", &method, own)
    }
}

/// Refuses keys that stand there but belong to other algorithms.
fn refuse(foreign: &[(&str, bool)], owners: &str, method: &Method, own: &str) -> Result<Method, String> {
    match foreign.iter().find(|(_, stated)| *stated) {
        None => Ok(*method),
        Some((key, _)) => Err(format!(
            "{key} belongs to algorithm {owners}; {} takes {own}",
            method.name()
        )),
    }
}
