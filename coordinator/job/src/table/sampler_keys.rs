//! Which keys of `[sampler]` belong to which algorithm.

use shared::file::unknown_word;

use super::algorithm_settings::AlgorithmName;
use super::error::TableError;

/// An algorithm and its keys.
#[derive(Debug, Clone, Copy)]
pub(super) struct SamplerKeys {
    /// The algorithm.
    pub(super) algorithm: AlgorithmName,
    keys: &'static [&'static str],
}

const ALL: [SamplerKeys; 7] = [
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
    },
    SamplerKeys {
        algorithm: AlgorithmName::ChingChen2007,
        keys: &["particles", "moves", "seed", "point_estimates"],
    },
    SamplerKeys {
        algorithm: AlgorithmName::Basis,
        keys: &["particles", "seed", "point_estimates"],
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
    },
    SamplerKeys {
        algorithm: AlgorithmName::Ga,
        keys: &["population", "generations", "seed"],
    },
    SamplerKeys {
        algorithm: AlgorithmName::CmaEs,
        keys: &["population", "max_evaluations", "restarts", "seed"],
    },
    SamplerKeys {
        algorithm: AlgorithmName::Discovery,
        keys: &["seed"],
    },
];

impl SamplerKeys {
    /// The keys of an algorithm.
    pub(super) fn of(algorithm: &str) -> Result<SamplerKeys, TableError> {
        ALL.into_iter()
            .find(|keys| keys.algorithm.name() == algorithm)
            .ok_or_else(|| {
                let known = AlgorithmName::STATED.map(AlgorithmName::name);
                TableError::Unknown(unknown_word("algorithm", algorithm, known))
            })
    }

    /// Rejects keys of other algorithms, given each key and whether the job has it.
    pub(super) fn refuse(&self, stated: &[(&str, bool)]) -> Result<(), TableError> {
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
