//! The settings of CMA-ES.

use super::rates::default_population;
use crate::evolution::settings_error::{EvolutionSettingsError, check_population};

/// Settings of CMA-ES.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CmaEsSettings {
    /// Individuals of a generation of the first run; `None`: 4 + floor(3 ln d) for d parameters. More individuals keep more
    /// workers busy.
    pub population: Option<usize>,
    /// Maximum number of evaluations of all runs together.
    pub max_evaluations: usize,
    /// Maximum number of restarts, each with twice the population of the last.
    pub restarts: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// A run has converged when the best of its last generations and the last generation differ by less, in nats.
    pub tolerance: f64,
}

impl Default for CmaEsSettings {
    /// Returns the default population, 5000 evaluations, 4 restarts, seed 1, tolerance 0.001 nats.
    fn default() -> Self {
        Self {
            population: None,
            max_evaluations: 5000,
            restarts: 4,
            seed: 1,
            tolerance: 1e-3,
        }
    }
}

impl CmaEsSettings {
    /// Smallest population: the better half, at least two, makes the next mean.
    pub const MIN_POPULATION: usize = 4;
    /// Largest number of evaluations.
    pub const MAX_EVALUATIONS: usize = 1_000_000;
    /// Largest number of restarts; the population doubles with each.
    pub const MAX_RESTARTS: usize = 20;

    /// Returns individuals of a generation of the first run.
    #[must_use]
    pub fn first_population(&self, dimension: usize) -> usize {
        self.population.unwrap_or_else(|| default_population(dimension))
    }

    pub(crate) fn check(&self, dimension: usize) -> Result<(), EvolutionSettingsError> {
        let population = self.first_population(dimension);
        check_population(population, Self::MIN_POPULATION)?;
        let min = 2 * population;
        if !(min..=Self::MAX_EVALUATIONS).contains(&self.max_evaluations) {
            return Err(EvolutionSettingsError::Evaluations {
                max_evaluations: self.max_evaluations,
                min,
                max: Self::MAX_EVALUATIONS,
            });
        }
        if self.restarts > Self::MAX_RESTARTS {
            return Err(EvolutionSettingsError::Restarts {
                restarts: self.restarts,
                max: Self::MAX_RESTARTS,
            });
        }
        Ok(())
    }
}
