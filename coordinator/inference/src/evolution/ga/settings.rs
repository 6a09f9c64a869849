//! The settings of a genetic algorithm.

use crate::evolution::settings_error::{EvolutionSettingsError, check_population};

/// Settings of a genetic algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaSettings {
    /// Number of individuals of a generation.
    pub population: usize,
    /// Maximum number of generations, including the prior draws.
    pub generations: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of best individuals that survive unchanged; they are not evaluated again.
    pub elite: usize,
    /// Number of generations without an improvement after which the evolution has converged.
    pub patience: usize,
    /// Smallest improvement that counts, in nats.
    pub tolerance: f64,
}

impl Default for GaSettings {
    /// Returns 100 individuals, 200 generations, seed 1, 2 of the elite, 25 generations without a gain of 0.001 nats.
    fn default() -> Self {
        Self {
            population: 100,
            generations: 200,
            seed: 1,
            elite: 2,
            patience: 25,
            tolerance: 1e-3,
        }
    }
}

impl GaSettings {
    /// Smallest population: tournaments need several members, and the elite must leave room for children.
    pub const MIN_POPULATION: usize = 8;
    /// Largest number of generations.
    pub const MAX_GENERATIONS: usize = 100_000;

    /// Returns the maximum number of evaluations of all generations; the elite saves some.
    #[must_use]
    pub fn max_evaluations(&self) -> usize {
        self.population.saturating_mul(self.generations)
    }

    pub(crate) fn check(&self) -> Result<(), EvolutionSettingsError> {
        check_population(self.population, Self::MIN_POPULATION)?;
        if !(2..=Self::MAX_GENERATIONS).contains(&self.generations) {
            return Err(EvolutionSettingsError::Generations {
                generations: self.generations,
                max: Self::MAX_GENERATIONS,
            });
        }
        if self.elite == 0 || 2 * self.elite > self.population {
            return Err(EvolutionSettingsError::Elite {
                elite: self.elite,
                population: self.population,
            });
        }
        Ok(())
    }
}
