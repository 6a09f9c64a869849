//! Errors in the settings of an evolution.

/// Largest population, which exceeds the number of workers of any farm.
pub const MAX_POPULATION: usize = 100_000;

/// A setting outside its bounds.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum EvolutionSettingsError {
    /// The prior has no parameters.
    #[error("the prior has no parameters")]
    NoParameters,
    /// The population is too small or too large.
    #[error("population = {population} is not from {min} to {MAX_POPULATION}")]
    Population {
        /// The population as given.
        population: usize,
        /// The smallest possible population.
        min: usize,
    },
    /// The generations are too few or too many.
    #[error("generations = {generations} is not from 2 to {max}")]
    Generations {
        /// The generations as given.
        generations: usize,
        /// The largest possible number of generations.
        max: usize,
    },
    /// The elite is empty, or leaves too few children.
    #[error("elite = {elite} is not from 1 to half of the population, {population}")]
    Elite {
        /// The elite as given.
        elite: usize,
        /// The size of the population as given.
        population: usize,
    },
    /// The budget is too large, or too small for a second generation.
    #[error("max_evaluations = {max_evaluations} is not from {min} (two generations) to {max}")]
    Evaluations {
        /// The budget as given.
        max_evaluations: usize,
        /// The smallest possible budget.
        min: usize,
        /// The largest possible budget.
        max: usize,
    },
    /// The restarts double the population too often.
    #[error("restarts = {restarts} is above {max}")]
    Restarts {
        /// The restarts as given.
        restarts: usize,
        /// The largest possible number of restarts.
        max: usize,
    },
    /// The tolerance is not a finite number above 0.
    #[error("tolerance = {value} is not a finite number above 0")]
    Tolerance {
        /// The tolerance as given.
        value: f64,
    },
}

/// Refuses a population out of bounds.
pub(crate) fn check_population(population: usize, min: usize) -> Result<(), EvolutionSettingsError> {
    if (min..=MAX_POPULATION).contains(&population) {
        Ok(())
    } else {
        Err(EvolutionSettingsError::Population { population, min })
    }
}
