//! The settings of an evolution.

use super::cma_es::CmaEsSettings;
use super::ga::GaSettings;
use super::settings_error::EvolutionSettingsError;

/// Settings of an evolution: the strategy with its own settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EvolutionSettings {
    /// A genetic algorithm.
    Ga(GaSettings),
    /// Covariance matrix adaptation.
    CmaEs(CmaEsSettings),
}

impl EvolutionSettings {
    /// Returns the seed of all random numbers.
    #[must_use]
    pub fn seed(&self) -> u64 {
        match self {
            Self::Ga(settings) => settings.seed,
            Self::CmaEs(settings) => settings.seed,
        }
    }

    /// Returns the maximum number of evaluations of all generations together.
    #[must_use]
    pub fn max_evaluations(&self) -> usize {
        match self {
            Self::Ga(settings) => settings.max_evaluations(),
            Self::CmaEs(settings) => settings.max_evaluations,
        }
    }

    /// Checks the settings for a prior of `dimension` parameters.
    ///
    /// # Errors
    /// [`EvolutionSettingsError`] with the setting, its value and its bound.
    pub fn check(&self, dimension: usize) -> Result<(), EvolutionSettingsError> {
        if dimension == 0 {
            return Err(EvolutionSettingsError::NoParameters);
        }
        let value = match self {
            Self::Ga(settings) => {
                settings.check()?;
                settings.tolerance
            }
            Self::CmaEs(settings) => {
                settings.check(dimension)?;
                settings.tolerance
            }
        };
        if value.is_finite() && value > 0.0 {
            Ok(())
        } else {
            Err(EvolutionSettingsError::Tolerance { value })
        }
    }
}
