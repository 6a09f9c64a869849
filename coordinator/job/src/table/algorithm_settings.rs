//! The algorithm of a calibration with its settings.

use inference::evolution::{CmaEsSettings, EvolutionSettings, EvolutionSettingsError};
use inference::lm::{LmSettings, LmSettingsError};
use inference::{Algorithm, TmcmcSettings, TmcmcSettingsError};

/// How parameters are found.
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

/// Largest number of questions in a round of a search for a missing effect.
const DISCOVERY_WIDTH: usize = 100_000;

/// Settings that do not fit the prior.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum AlgorithmSettingsError {
    /// The sampler's.
    #[error(transparent)]
    Sample(#[from] TmcmcSettingsError),
    /// The fit's.
    #[error(transparent)]
    Fit(#[from] LmSettingsError),
    /// The evolution's.
    #[error(transparent)]
    Evolve(#[from] EvolutionSettingsError),
}

/// An algorithm by its name in files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(into = "&str", try_from = "String")]
pub enum AlgorithmName {
    /// Transitional Markov chain Monte Carlo.
    Tmcmc,
    /// TMCMC as published by Ching and Chen in 2007.
    ChingChen2007,
    /// BASIS.
    Basis,
    /// Levenberg-Marquardt.
    Lm,
    /// Genetic algorithm.
    Ga,
    /// Covariance matrix adaptation.
    CmaEs,
    /// Search for a missing effect, which a study starts by itself: no job states it.
    Discovery,
}

impl AlgorithmName {
    /// Every algorithm.
    const ALL: [AlgorithmName; 7] = [
        AlgorithmName::Tmcmc,
        AlgorithmName::ChingChen2007,
        AlgorithmName::Basis,
        AlgorithmName::Lm,
        AlgorithmName::Ga,
        AlgorithmName::CmaEs,
        AlgorithmName::Discovery,
    ];

    /// The algorithms that find the most probable parameters, which a job may ask for beside a sample.
    pub const POINT_ESTIMATES: [AlgorithmName; 3] =
        [AlgorithmName::Lm, AlgorithmName::Ga, AlgorithmName::CmaEs];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            AlgorithmName::Tmcmc => "tmcmc",
            AlgorithmName::ChingChen2007 => "ching-chen-2007",
            AlgorithmName::Basis => "basis",
            AlgorithmName::Lm => "lm",
            AlgorithmName::Ga => "ga",
            AlgorithmName::CmaEs => "cma-es",
            AlgorithmName::Discovery => "discovery",
        }
    }
}

impl From<AlgorithmName> for &'static str {
    fn from(algorithm: AlgorithmName) -> Self {
        algorithm.name()
    }
}

impl TryFrom<String> for AlgorithmName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let known = AlgorithmName::ALL.into_iter().find(|known| known.name() == name);
        known.ok_or_else(|| format!("unknown algorithm \"{name}\""))
    }
}

impl AlgorithmSettings {
    /// The algorithm.
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

    /// The algorithm's name in files.
    pub fn name(&self) -> &'static str {
        self.algorithm_name().name()
    }

    /// The algorithm with its size: `tmcmc with 1000 particles`.
    pub fn words(&self) -> String {
        let name = self.name();
        match self {
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

    /// Whether it ends with draws of the posterior, or of its normal approximation.
    pub fn has_posterior(&self) -> bool {
        match self {
            AlgorithmSettings::Sample(_) => true,
            AlgorithmSettings::Fit(settings) => settings.draws > 0,
            AlgorithmSettings::Evolve(_) | AlgorithmSettings::Discover { .. } => false,
        }
    }

    /// Whether predicted values are told, not log-likelihoods alone: to a fit, a search, and where a metamodel learns.
    pub fn is_told_values(&self) -> bool {
        let told = matches!(
            self,
            AlgorithmSettings::Fit(_) | AlgorithmSettings::Discover { .. }
        );
        told || self.has_metamodel()
    }

    /// Whether a metamodel takes moves between evaluations.
    pub fn has_metamodel(&self) -> bool {
        self.metamodel_moves() > 0
    }

    /// Moves of a metamodel between two evaluations.
    pub fn metamodel_moves(&self) -> usize {
        match self {
            AlgorithmSettings::Sample(settings) => settings.metamodel_moves,
            AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(_) | AlgorithmSettings::Discover { .. } => {
                0
            }
        }
    }

    /// The key of the budget that a longer run needs more of.
    pub fn budget_key(&self) -> &'static str {
        match self {
            AlgorithmSettings::Sample(_) | AlgorithmSettings::Discover { .. } => "particles",
            AlgorithmSettings::Evolve(EvolutionSettings::Ga(_)) => "generations",
            AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(_)) => {
                "max_evaluations"
            }
        }
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        match self {
            AlgorithmSettings::Sample(settings) => settings.seed,
            AlgorithmSettings::Fit(settings) => settings.seed,
            AlgorithmSettings::Evolve(settings) => settings.seed(),
            AlgorithmSettings::Discover { seed } => *seed,
        }
    }

    /// Largest number of proposals in a round: evaluations are numbered by it.
    pub fn width(&self) -> usize {
        match self {
            AlgorithmSettings::Sample(settings) => settings.particles,
            AlgorithmSettings::Fit(settings) => settings.max_evaluations,
            AlgorithmSettings::Evolve(EvolutionSettings::Ga(settings)) => settings.population,
            AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(settings)) => settings.max_evaluations,
            AlgorithmSettings::Discover { .. } => DISCOVERY_WIDTH,
        }
    }

    /// Largest number of evaluations, where the settings state one.
    pub fn max_evaluations(&self) -> Option<usize> {
        match self {
            AlgorithmSettings::Sample(_) | AlgorithmSettings::Discover { .. } => None,
            AlgorithmSettings::Fit(settings) => Some(settings.max_evaluations),
            AlgorithmSettings::Evolve(settings) => Some(settings.max_evaluations()),
        }
    }

    /// Checks the settings for so many parameters.
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
