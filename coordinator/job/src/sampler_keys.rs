//! Which keys of `[sampler]` belong to which algorithm.

use shared::file::unknown_word;

/// An algorithm and its keys.
#[derive(Debug, Clone, Copy)]
pub(super) struct Keys {
    /// Its name in files.
    pub(super) algorithm: &'static str,
    keys: &'static [&'static str],
}

const ALL: [Keys; 7] = [
    Keys {
        algorithm: "tmcmc",
        keys: &["particles", "moves", "metamodel_moves", "seed", "point_estimates"],
    },
    Keys {
        algorithm: "ching-chen-2007",
        keys: &["particles", "moves", "seed", "point_estimates"],
    },
    Keys {
        algorithm: "basis",
        keys: &["particles", "seed", "point_estimates"],
    },
    Keys {
        algorithm: "lm",
        keys: &["starts", "max_evaluations", "difference_step", "seed"],
    },
    Keys {
        algorithm: "ga",
        keys: &["population", "generations", "seed"],
    },
    Keys {
        algorithm: "cma-es",
        keys: &["population", "max_evaluations", "restarts", "seed"],
    },
    Keys {
        algorithm: "discovery",
        keys: &["seed"],
    },
];

impl Keys {
    /// The keys of an algorithm.
    pub(super) fn of(algorithm: &str) -> Result<Keys, String> {
        ALL.into_iter()
            .find(|keys| keys.algorithm == algorithm)
            .ok_or_else(|| unknown_word("algorithm", algorithm, ALL.map(|keys| keys.algorithm)))
    }

    /// Refuses keys that stand there but belong to other algorithms; given is each key and whether it stands there.
    pub(super) fn refuse(&self, stated: &[(&str, bool)]) -> Result<(), String> {
        let foreign = stated
            .iter()
            .find(|(key, is_stated)| *is_stated && !self.keys.contains(key));
        let Some((key, _)) = foreign else { return Ok(()) };
        let owners: Vec<&str> = ALL
            .iter()
            .filter(|keys| keys.keys.contains(key))
            .map(|keys| keys.algorithm)
            .collect();
        Err(format!(
            "{key} belongs to algorithm {}; {} takes {}",
            owners.join(" and "),
            self.algorithm,
            self.keys.join(", ")
        ))
    }
}
