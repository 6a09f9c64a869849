//! The table `[sampler]`: which algorithm, and its settings.

use inference::evolution::{CmaEsSettings, EvolutionSettings, EvolutionSettingsError, GaSettings};
use inference::lm::{LmSettings, LmSettingsError};
use inference::{Algorithm, TmcmcSettings, TmcmcSettingsError};
use serde::Deserialize;
use shared::file::unknown_word;

use super::sampler_keys::Keys;

/// How parameters are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlgorithmSettings {
    /// A sample of the posterior.
    Sample(TmcmcSettings),
    /// The most probable parameters, by steps.
    Fit(LmSettings),
    /// The most probable parameters, by generations.
    Evolve(EvolutionSettings),
    /// What the model is missing.
    Discover {
        /// Seed of the draws.
        seed: u64,
    },
}

/// No round of a search for a missing effect has more questions.
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
pub enum AlgorithmName {
    /// Transitional Markov chain Monte Carlo.
    #[serde(rename = "tmcmc")]
    Tmcmc,
    /// The same as published by Ching and Chen in 2007.
    #[serde(rename = "ching-chen-2007")]
    ChingChen2007,
    /// BASIS.
    #[serde(rename = "basis")]
    Basis,
    /// Levenberg-Marquardt.
    #[serde(rename = "lm")]
    Lm,
    /// Genetic algorithm.
    #[serde(rename = "ga")]
    Ga,
    /// Covariance matrix adaptation.
    #[serde(rename = "cma-es")]
    CmaEs,
    /// Search for a missing effect.
    #[serde(rename = "discovery")]
    Discovery,
}

impl AlgorithmName {
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

impl AlgorithmSettings {
    /// The algorithm.
    pub fn algorithm(&self) -> AlgorithmName {
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
        self.algorithm().name()
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
            AlgorithmSettings::Fit(LmSettings { max_evaluations, .. })
            | AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(CmaEsSettings {
                max_evaluations, ..
            })) => {
                format!("{name} with at most {max_evaluations} evaluations")
            }
            AlgorithmSettings::Discover { .. } => name.to_owned(),
        }
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

    /// More proposals than this are in no round: evaluations are numbered by it.
    pub fn width(&self) -> usize {
        match self {
            AlgorithmSettings::Sample(settings) => settings.particles,
            AlgorithmSettings::Fit(settings) => settings.max_evaluations,
            AlgorithmSettings::Evolve(EvolutionSettings::Ga(settings)) => settings.population,
            AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(settings)) => settings.max_evaluations,
            AlgorithmSettings::Discover { .. } => DISCOVERY_WIDTH,
        }
    }

    /// Most evaluations, where the job says so.
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

/// Least and most steps of a stage whose steps are subchains of a metamodel.
const METAMODEL_STEPS: [usize; 2] = [3, 30];
/// The algorithms that find the most probable parameters.
const POINT_ESTIMATES: [&str; 3] = ["lm", "ga", "cma-es"];

/// The table as written; every algorithm reads its own keys.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct RawSampler {
    algorithm: Option<String>,
    seed: Option<u64>,
    particles: Option<usize>,
    moves: Option<[usize; 2]>,
    metamodel_moves: Option<usize>,
    starts: Option<usize>,
    max_evaluations: Option<usize>,
    difference_step: Option<f64>,
    population: Option<usize>,
    generations: Option<usize>,
    restarts: Option<usize>,
    point_estimates: Option<Vec<String>>,
}

impl RawSampler {
    /// The algorithm with its settings.
    pub(super) fn method(&self) -> Result<AlgorithmSettings, String> {
        let keys = Keys::of(self.algorithm.as_deref().unwrap_or("tmcmc"))?;
        keys.refuse(&[
            ("particles", self.particles.is_some()),
            ("moves", self.moves.is_some()),
            ("metamodel_moves", self.metamodel_moves.is_some()),
            ("starts", self.starts.is_some()),
            ("max_evaluations", self.max_evaluations.is_some()),
            ("difference_step", self.difference_step.is_some()),
            ("population", self.population.is_some()),
            ("generations", self.generations.is_some()),
            ("restarts", self.restarts.is_some()),
            ("point_estimates", self.point_estimates.is_some()),
        ])?;
        Ok(match keys.algorithm {
            "ching-chen-2007" => self.sample(Algorithm::ChingChen2007),
            "basis" => self.sample(Algorithm::Basis),
            "lm" => self.fit(),
            "ga" => self.ga(),
            "cma-es" => self.cma_es(),
            "discovery" => AlgorithmSettings::Discover {
                seed: self.seed.unwrap_or(TmcmcSettings::default().seed),
            },
            _ => self.sample(Algorithm::Tmcmc),
        })
    }

    /// The fits and searches beside the sample: each with its usual settings and the sample's seed.
    pub(super) fn point_estimates(&self, seed: u64) -> Result<Vec<AlgorithmSettings>, String> {
        let names = self.point_estimates.as_deref().unwrap_or_default();
        let method = |(i, name): (usize, &String)| {
            if !POINT_ESTIMATES.contains(&name.as_str()) {
                return Err(unknown_word("point estimate", name, POINT_ESTIMATES));
            }
            if names[..i].contains(name) {
                return Err(format!("point_estimates names {name} twice"));
            }
            RawSampler {
                algorithm: Some(name.clone()),
                seed: Some(seed),
                ..RawSampler::default()
            }
            .method()
        };
        names.iter().enumerate().map(method).collect()
    }

    fn sample(&self, algorithm: Algorithm) -> AlgorithmSettings {
        let usual = TmcmcSettings::default();
        let metamodel_moves = self.metamodel_moves.unwrap_or(usual.metamodel_moves);
        // A step of many moves forgets more than one of one.
        let moves = if metamodel_moves > 0 {
            METAMODEL_STEPS
        } else {
            usual.moves
        };
        AlgorithmSettings::Sample(TmcmcSettings {
            algorithm,
            particles: self.particles.unwrap_or(usual.particles),
            moves: self.moves.unwrap_or(moves),
            metamodel_moves,
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        })
    }

    fn fit(&self) -> AlgorithmSettings {
        let usual = LmSettings::default();
        AlgorithmSettings::Fit(LmSettings {
            starts: self.starts.unwrap_or(usual.starts),
            max_evaluations: self.max_evaluations.unwrap_or(usual.max_evaluations),
            difference_step: self.difference_step.unwrap_or(usual.difference_step),
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        })
    }

    fn ga(&self) -> AlgorithmSettings {
        let usual = GaSettings::default();
        AlgorithmSettings::Evolve(EvolutionSettings::Ga(GaSettings {
            population: self.population.unwrap_or(usual.population),
            generations: self.generations.unwrap_or(usual.generations),
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        }))
    }

    fn cma_es(&self) -> AlgorithmSettings {
        let usual = CmaEsSettings::default();
        AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(CmaEsSettings {
            population: self.population,
            max_evaluations: self.max_evaluations.unwrap_or(usual.max_evaluations),
            restarts: self.restarts.unwrap_or(usual.restarts),
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        }))
    }
}
