//! Why the settings of an evolution are refused.

use super::settings::EvolutionSettings;

/// Why settings are refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum EvolutionSettingsError {
    /// The prior has no parameters.
    #[error("the prior has no parameters")]
    NoParameters,
    /// The population is too small or too large.
    #[error(
        "population = {population} is not from {least} to {}",
        EvolutionSettings::MAX_POPULATION
    )]
    Population {
        /// The setting.
        population: usize,
        /// The least population.
        least: usize,
    },
    /// The generations are too few or too many.
    #[error("generations = {generations} is not from 2 to {most}")]
    Generations {
        /// The setting.
        generations: usize,
        /// The most generations.
        most: usize,
    },
    /// The elite is empty, or leaves too few children.
    #[error("elite = {elite} is not from 1 to half of the population, {population}")]
    Elite {
        /// The setting.
        elite: usize,
        /// The population.
        population: usize,
    },
    /// The budget is too large, or too small for a second generation.
    #[error("max_evaluations = {max_evaluations} is not from {least} (two generations) to {most}")]
    Evaluations {
        /// The setting.
        max_evaluations: usize,
        /// The least budget.
        least: usize,
        /// The most evaluations.
        most: usize,
    },
    /// The restarts double the population too often.
    #[error("restarts = {restarts} is above {most}")]
    Restarts {
        /// The setting.
        restarts: usize,
        /// The most restarts.
        most: usize,
    },
    /// The tolerance is not a finite number above 0.
    #[error("tolerance = {value} is not a finite number above 0")]
    Tolerance {
        /// The setting.
        value: f64,
    },
}

/// Refuses a population out of bounds.
pub(crate) fn check_population(population: usize, least: usize) -> Result<(), EvolutionSettingsError> {
    if (least..=EvolutionSettings::MAX_POPULATION).contains(&population) {
        Ok(())
    } else {
        Err(EvolutionSettingsError::Population { population, least })
    }
}
