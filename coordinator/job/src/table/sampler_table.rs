//! The table `[sampler]`: which algorithm, and its settings.

use inference::evolution::{CmaEsSettings, EvolutionSettings, GaSettings};
use inference::lm::LmSettings;
use inference::{Algorithm, StageMethod, TmcmcSettings};
use serde::Deserialize;
use shared::file::unknown_word;

use super::algorithm_settings::{AlgorithmName, AlgorithmSettings};
use super::error::TableError;

/// Least and most steps of a stage whose steps are subchains of a metamodel.
const METAMODEL_STEPS: [usize; 2] = [3, 30];
/// The values of `stages`.
const STAGES: [&str; 2] = ["draws", "moves"];

/// An algorithm and its keys.
#[derive(Debug, Clone, Copy)]
struct SamplerKeys {
    /// The algorithm.
    algorithm: AlgorithmName,
    keys: &'static [&'static str],
    /// Reads them.
    read: fn(&RawSampler) -> Result<AlgorithmSettings, TableError>,
}

const ALL: [SamplerKeys; 6] = [
    SamplerKeys {
        algorithm: AlgorithmName::Tmcmc,
        keys: &[
            "particles",
            "stages",
            "components",
            "moves",
            "metamodel_moves",
            "seed",
            "point_estimates",
        ],
        read: |raw| raw.sample(Algorithm::Tmcmc),
    },
    SamplerKeys {
        algorithm: AlgorithmName::ChingChen2007,
        keys: &["particles", "moves", "seed", "point_estimates"],
        read: |raw| raw.sample(Algorithm::ChingChen2007),
    },
    SamplerKeys {
        algorithm: AlgorithmName::Basis,
        keys: &["particles", "seed", "point_estimates"],
        read: |raw| raw.sample(Algorithm::Basis),
    },
    SamplerKeys {
        algorithm: AlgorithmName::Lm,
        keys: &[
            "particles",
            "starts",
            "max_evaluations",
            "difference_step",
            "seed",
        ],
        read: RawSampler::fit,
    },
    SamplerKeys {
        algorithm: AlgorithmName::Ga,
        keys: &["population", "generations", "seed"],
        read: RawSampler::ga,
    },
    SamplerKeys {
        algorithm: AlgorithmName::CmaEs,
        keys: &["population", "max_evaluations", "restarts", "seed"],
        read: RawSampler::cma_es,
    },
];

impl SamplerKeys {
    /// The keys of an algorithm.
    fn of(algorithm: &str) -> Result<SamplerKeys, TableError> {
        ALL.into_iter()
            .find(|keys| keys.algorithm.name() == algorithm)
            .ok_or_else(|| {
                let known = AlgorithmName::STATED.map(AlgorithmName::name);
                TableError::Unknown(unknown_word("algorithm", algorithm, known))
            })
    }

    /// Rejects keys of other algorithms, given each key and whether the job has it.
    fn refuse(&self, stated: &[(&str, bool)]) -> Result<(), TableError> {
        let foreign = stated
            .iter()
            .find(|(key, is_stated)| *is_stated && !self.keys.contains(key));
        let Some((key, _)) = foreign else { return Ok(()) };
        let owners: Vec<&str> = ALL
            .iter()
            .filter(|keys| keys.keys.contains(key))
            .map(|keys| keys.algorithm.name())
            .collect();
        Err(TableError::ForeignKey {
            key: (*key).to_owned(),
            owners: owners.join(" and "),
            algorithm: self.algorithm.name(),
            keys: self.keys.join(", "),
        })
    }
}

/// The table as written; every algorithm reads its own keys.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct RawSampler {
    algorithm: Option<String>,
    seed: Option<u64>,
    particles: Option<usize>,
    stages: Option<String>,
    components: Option<usize>,
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
    pub(crate) fn algorithm(&self) -> Result<AlgorithmSettings, TableError> {
        let keys = SamplerKeys::of(self.algorithm.as_deref().unwrap_or(AlgorithmName::Tmcmc.name()))?;
        keys.refuse(&[
            ("particles", self.particles.is_some()),
            ("stages", self.stages.is_some()),
            ("components", self.components.is_some()),
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
        (keys.read)(self)
    }

    /// The fits and searches beside the sample: each with its usual settings and the sample's seed.
    pub(crate) fn point_estimates(&self, seed: u64) -> Result<Vec<AlgorithmSettings>, TableError> {
        let names = self.point_estimates.as_deref().unwrap_or_default();
        let algorithm = |(i, name): (usize, &String)| {
            let known = AlgorithmName::POINT_ESTIMATES.map(AlgorithmName::name);
            if !known.contains(&name.as_str()) {
                let unknown = unknown_word("point estimate", name, known);
                return Err(TableError::Unknown(unknown));
            }
            if names[..i].contains(name) {
                return Err(TableError::Twice(name.clone()));
            }
            RawSampler {
                algorithm: Some(name.clone()),
                seed: Some(seed),
                // Beside a sample no draws of an approximation are wanted.
                particles: (name == AlgorithmName::Lm.name()).then_some(0),
                ..RawSampler::default()
            }
            .algorithm()
        };
        names.iter().enumerate().map(algorithm).collect()
    }

    fn sample(&self, algorithm: Algorithm) -> Result<AlgorithmSettings, TableError> {
        let usual = TmcmcSettings::default();
        let metamodel_moves = self.metamodel_moves.unwrap_or(usual.metamodel_moves);
        let stages = match self.stages.as_deref() {
            Some("draws") => StageMethod::Draws,
            Some("moves") => StageMethod::Moves,
            Some(other) => {
                return Err(TableError::Unknown(unknown_word(
                    "value of stages",
                    other,
                    STAGES,
                )));
            }
            None if metamodel_moves > 0 => StageMethod::Moves,
            None => usual.stages,
        };
        if let (StageMethod::Moves, Some(components)) = (stages, self.components) {
            let rule = "belongs to stages = \"draws\"";
            return Err(TableError::value("components", components, rule));
        }
        // A step of many moves forgets more than one of one.
        let moves = if metamodel_moves > 0 {
            METAMODEL_STEPS
        } else {
            usual.moves
        };
        Ok(AlgorithmSettings::Sample(TmcmcSettings {
            algorithm,
            stages,
            particles: self.particles.unwrap_or(usual.particles),
            components: self.components.unwrap_or(usual.components),
            moves: self.moves.unwrap_or(moves),
            metamodel_moves,
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        }))
    }

    fn fit(&self) -> Result<AlgorithmSettings, TableError> {
        let usual = LmSettings::default();
        Ok(AlgorithmSettings::Fit(LmSettings {
            starts: self.starts.unwrap_or(usual.starts),
            max_evaluations: self.max_evaluations.unwrap_or(usual.max_evaluations),
            draws: self.particles.unwrap_or(usual.draws),
            difference_step: self.difference_step.unwrap_or(usual.difference_step),
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        }))
    }

    fn ga(&self) -> Result<AlgorithmSettings, TableError> {
        let usual = GaSettings::default();
        Ok(AlgorithmSettings::Evolve(EvolutionSettings::Ga(GaSettings {
            population: self.population.unwrap_or(usual.population),
            generations: self.generations.unwrap_or(usual.generations),
            seed: self.seed.unwrap_or(usual.seed),
            ..usual
        })))
    }

    fn cma_es(&self) -> Result<AlgorithmSettings, TableError> {
        let usual = CmaEsSettings::default();
        Ok(AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(
            CmaEsSettings {
                population: self.population,
                max_evaluations: self.max_evaluations.unwrap_or(usual.max_evaluations),
                restarts: self.restarts.unwrap_or(usual.restarts),
                seed: self.seed.unwrap_or(usual.seed),
                ..usual
            },
        )))
    }
}
