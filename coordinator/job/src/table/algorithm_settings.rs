//! The algorithm of a calibration with its settings.

use inference::evolution::{CmaEsSettings, EvolutionSettings, EvolutionSettingsError};
use inference::lm::{LmSettings, LmSettingsError};
use inference::{Algorithm, StageMethod, TmcmcSettings, TmcmcSettingsError};
use shared::model::ModelKind;
use strum::{EnumString, IntoStaticStr};

/// The algorithm that finds the parameters, with its settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlgorithmSettings {
    /// A sample of the posterior.
    Sample(TmcmcSettings),
    /// The most probable parameters, by steps.
    Fit(LmSettings),
    /// The most probable parameters, by generations.
    Evolve(EvolutionSettings),
    /// A search for effects that the model misses.
    Discover {
        /// Seed of the draws.
        seed: u64,
    },
}

/// Largest number of evaluations in a round of a search for a missing effect.
const DISCOVERY_WIDTH: usize = 100_000;
/// Bound on the evaluations in the first design of an emulator, of up to 160 parameters, and on its final draws.
const EMULATED_WIDTH: usize = 1000;

/// Settings that the prior's number of parameters does not allow.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum AlgorithmSettingsError {
    /// Error of the sampler's settings.
    #[error(transparent)]
    Sample(#[from] TmcmcSettingsError),
    /// Error of the fit's settings.
    #[error(transparent)]
    Fit(#[from] LmSettingsError),
    /// Error of the evolution's settings.
    #[error(transparent)]
    Evolve(#[from] EvolutionSettingsError),
}

/// An algorithm by its name in files.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, EnumString, IntoStaticStr,
)]
#[serde(into = "&str", try_from = "String")]
#[strum(serialize_all = "kebab-case")]
pub enum AlgorithmName {
    /// Transitional Markov chain Monte Carlo.
    Tmcmc,
    /// TMCMC as published by Ching and Chen in 2007.
    #[strum(serialize = "ching-chen-2007")]
    ChingChen2007,
    /// Bayesian annealed sequential importance sampling (BASIS).
    Basis,
    /// Levenberg-Marquardt.
    Lm,
    /// Genetic algorithm (GA).
    Ga,
    /// Covariance matrix adaptation evolution strategy (CMA-ES).
    CmaEs,
    /// Search for a missing effect; a study starts it, and no job states it.
    Discovery,
}

impl AlgorithmName {
    /// The algorithms that find the most probable parameters, which a job may run beside a sample.
    pub const POINT_ESTIMATES: [AlgorithmName; 3] =
        [AlgorithmName::Lm, AlgorithmName::Ga, AlgorithmName::CmaEs];

    /// Returns the name in files.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

impl TryFrom<String> for AlgorithmName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        name.parse().map_err(|_| format!("unknown algorithm \"{name}\""))
    }
}

impl AlgorithmSettings {
    /// Returns the algorithm.
    pub fn algorithm_name(&self) -> AlgorithmName {
        match self {
            AlgorithmSettings::Sample(settings) => match settings.algorithm {
                Algorithm::Tmcmc => AlgorithmName::Tmcmc,
                Algorithm::ChingChen2007 => AlgorithmName::ChingChen2007,
                Algorithm::Basis => AlgorithmName::Basis,
            },
            AlgorithmSettings::Fit(_) => AlgorithmName::Lm,
            AlgorithmSettings::Evolve(EvolutionSettings::Ga(_)) => AlgorithmName::Ga,
            AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(_)) => AlgorithmName::CmaEs,
            AlgorithmSettings::Discover { .. } => AlgorithmName::Discovery,
        }
    }

    /// Returns the algorithm's name in files.
    pub fn name(&self) -> &'static str {
        self.algorithm_name().name()
    }

    /// Returns the algorithm with its size: `tmcmc with 1000 particles`.
    pub fn words(&self) -> String {
        let name = self.name();
        match self {
            AlgorithmSettings::Sample(settings) if self.is_emulated() => format!(
                "{name} on an emulator of the model, in rounds of {} evaluations",
                settings.batch
            ),
            AlgorithmSettings::Sample(settings) => format!("{name} with {} particles", settings.particles),
            AlgorithmSettings::Evolve(EvolutionSettings::Ga(settings)) => format!(
                "{name} with at most {} generations of {}",
                settings.generations, settings.population
            ),
            AlgorithmSettings::Fit(LmSettings {
                max_evaluations,
                draws: draws @ 1..,
                ..
            }) => format!(
                "{name} with at most {max_evaluations} evaluations, and {draws} draws of the normal approximation"
            ),
            AlgorithmSettings::Fit(LmSettings { max_evaluations, .. })
            | AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(CmaEsSettings {
                max_evaluations, ..
            })) => {
                format!("{name} with at most {max_evaluations} evaluations")
            }
            AlgorithmSettings::Discover { .. } => name.to_owned(),
        }
    }

    /// Returns whether it ends with draws of the posterior, or of its normal approximation.
    pub fn has_posterior(&self) -> bool {
        match self {
            AlgorithmSettings::Sample(_) => true,
            AlgorithmSettings::Fit(settings) => settings.draws > 0,
            AlgorithmSettings::Evolve(_) | AlgorithmSettings::Discover { .. } => false,
        }
    }

    /// Returns the settings with the default stages for a kind of model: an expensive model is sampled on an emulator.
    pub(crate) fn with_stages_for(self, kind: ModelKind) -> Self {
        let stages = match kind {
            ModelKind::Scm | ModelKind::Rft | ModelKind::Command | ModelKind::Umbridge => {
                StageMethod::Emulated
            }
            ModelKind::QuasiStatic | ModelKind::WongReece => StageMethod::Draws,
        };
        match self {
            AlgorithmSettings::Sample(settings) => {
                AlgorithmSettings::Sample(TmcmcSettings { stages, ..settings })
            }
            other => other,
        }
    }

    /// Returns whether the posterior is sampled on an emulator of the model.
    pub fn is_emulated(&self) -> bool {
        matches!(self, AlgorithmSettings::Sample(settings)
            if settings.stages == StageMethod::Emulated && settings.algorithm == Algorithm::Tmcmc)
    }

    /// Returns the algorithm of a result for which no emulator was recorded: before store version 22, the job of such a sampler asked for
    /// draws of the model.
    #[must_use]
    pub fn without_emulator(self) -> Self {
        match self {
            AlgorithmSettings::Sample(settings) if self.is_emulated() => {
                AlgorithmSettings::Sample(TmcmcSettings {
                    stages: StageMethod::Draws,
                    ..settings
                })
            }
            other => other,
        }
    }

    /// Returns whether the engine receives predicted values in addition to log-likelihoods: fits, searches and emulators do.
    pub fn is_told_values(&self) -> bool {
        let told = matches!(
            self,
            AlgorithmSettings::Fit(_) | AlgorithmSettings::Discover { .. }
        );
        told || self.is_emulated()
    }

    /// Returns the key of the budget that a longer run increases.
    pub fn budget_key(&self) -> &'static str {
        match self {
            AlgorithmSettings::Sample(_) | AlgorithmSettings::Discover { .. } => "particles",
            AlgorithmSettings::Evolve(EvolutionSettings::Ga(_)) => "generations",
            AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(_)) => {
                "max_evaluations"
            }
        }
    }

    /// Returns the seed.
    pub fn seed(&self) -> u64 {
        match self {
            AlgorithmSettings::Sample(settings) => settings.seed,
            AlgorithmSettings::Fit(settings) => settings.seed,
            AlgorithmSettings::Evolve(settings) => settings.seed(),
            AlgorithmSettings::Discover { seed } => *seed,
        }
    }

    /// Returns the largest number of proposals in a round, which spaces the numbers of evaluations.
    pub fn width(&self) -> usize {
        match self {
            AlgorithmSettings::Sample(settings) if self.is_emulated() => {
                settings.particles.max(settings.batch).max(EMULATED_WIDTH)
            }
            AlgorithmSettings::Sample(settings) => settings.particles,
            AlgorithmSettings::Fit(settings) => settings.max_evaluations,
            AlgorithmSettings::Evolve(EvolutionSettings::Ga(settings)) => settings.population,
            AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(settings)) => settings.max_evaluations,
            AlgorithmSettings::Discover { .. } => DISCOVERY_WIDTH,
        }
    }

    /// Returns the largest number of evaluations, if the settings state one.
    pub fn max_evaluations(&self) -> Option<usize> {
        match self {
            AlgorithmSettings::Sample(_) | AlgorithmSettings::Discover { .. } => None,
            AlgorithmSettings::Fit(settings) => Some(settings.max_evaluations),
            AlgorithmSettings::Evolve(settings) => Some(settings.max_evaluations()),
        }
    }

    /// Checks the settings for a number of parameters.
    ///
    /// # Errors
    /// [`AlgorithmSettingsError`] names the setting, its value and its bound.
    pub fn check(&self, dimension: usize) -> Result<(), AlgorithmSettingsError> {
        match self {
            AlgorithmSettings::Sample(settings) => settings.check(dimension)?,
            AlgorithmSettings::Fit(settings) => settings.check(dimension)?,
            AlgorithmSettings::Evolve(settings) => settings.check(dimension)?,
            AlgorithmSettings::Discover { .. } => {}
        }
        Ok(())
    }
}
