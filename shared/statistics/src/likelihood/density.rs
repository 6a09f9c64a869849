//! The log-density of the data, and the probabilities of an unknown discrepancy.

use super::common_error::{Discrepancy, ErrorBlock, discrepancy_levels};
use super::datum::LikelihoodError;
use super::error_model::Likelihood;
use super::factor::CovarianceFactor;
use super::law::ErrorLaw;
use crate::log_likelihood::LogLikelihood;
use crate::prior::LN_SQRT_TAU;

/// A block with its factored covariance and whitened residuals.
pub(super) struct ScoredBlock {
    pub(super) factor: CovarianceFactor,
    pub(super) whitened: Vec<f64>,
    pub(super) squared_distance: f64,
}

impl Likelihood {
    /// Computes ln p(data | theta), normalised: comparable between noise levels and between models.
    ///
    /// For independent data, `sum_i [ -ln(sqrt(2 pi) sd_i) - (y_i - m_i)^2 / (2 sd_i^2) ]`, plus the log-density of each
    /// block; for blocks that share an unknown discrepancy, the logarithm of the mean over its values.
    ///
    /// # Arguments
    /// - `values`: the model's value of each datum, in its unit and in their order, then the derivatives that
    ///   [`Likelihood::sensitive`] lists.
    /// - `theta`: holds the inferred standard deviations, each > 0 (give them a positive prior).
    ///
    /// # Returns
    /// The sum, in nats; [`LogLikelihood::Impossible`] if a residual or a derivative is so large that the sum
    /// overflows.
    ///
    /// # Errors
    /// [`LikelihoodError::Prediction`], [`LikelihoodError::Noise`], [`LikelihoodError::MissingParameter`],
    /// [`LikelihoodError::Length`].
    ///
    /// # Source
    /// The normal density. The paper's Eq. 13-15 lack the factor 1/sigma; it is kept here, because without it an inferred
    /// sigma grows without bound and evidences of different noise models are not comparable. Checked by
    /// `likelihood::hand_numbers` and `likelihood::blocks_match_a_dense_density`.
    pub fn log_likelihood(&self, values: &[f64], theta: &[f64]) -> Result<LogLikelihood, LikelihoodError> {
        self.check_values(values)?;
        let mut sum = 0.0;
        for &i in &self.alone {
            let datum = &self.data[i];
            let sd = datum.noise_sd(theta)?;
            let residual = (datum.value - values[i]) / sd;
            sum += match self.law {
                ErrorLaw::Gaussian => -LN_SQRT_TAU - libm::log(sd) - 0.5 * residual * residual,
                law => law.log_density(1, residual * residual, 2.0 * libm::log(sd)),
            };
        }
        for block in self.blocks.iter().filter(|block| block.family.is_none()) {
            sum += self.block_density(block, 0.0, values, theta)?;
        }
        for family in 0..self.families.len() {
            sum += log_mean_exp(&self.by_level(family, values, theta)?);
        }
        Ok(LogLikelihood::new(sum)?)
    }

    /// Returns the values of m of each group with their posterior probabilities at these parameters; 0 without
    /// discrepancy. Errors are those of [`Likelihood::log_likelihood`].
    pub fn discrepancy_weights(
        &self,
        values: &[f64],
        theta: &[f64],
    ) -> Result<Vec<Vec<(f64, f64)>>, LikelihoodError> {
        self.check_values(values)?;
        let families = self.family_weights(values, theta)?;
        let levels = |(group, discrepancy): (usize, &Discrepancy)| match *discrepancy {
            Discrepancy::None => vec![(0.0, 1.0)],
            Discrepancy::Known(m) => vec![(m, 1.0)],
            Discrepancy::Unknown => {
                let family = self.families.iter().position(|family| family.contains(&group));
                family.map_or_else(|| equal_weights(discrepancy_levels()), |f| families[f].clone())
            }
        };
        Ok(self.discrepancies.iter().enumerate().map(levels).collect())
    }

    /// Returns the values of each unknown m with their posterior probabilities.
    pub(super) fn family_weights(
        &self,
        values: &[f64],
        theta: &[f64],
    ) -> Result<Vec<Vec<(f64, f64)>>, LikelihoodError> {
        let weights = |family| {
            let levels = discrepancy_levels();
            let densities = self.by_level(family, values, theta)?;
            let highest = densities.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if !highest.is_finite() {
                // The data exclude every value of m, so its prior probabilities are returned.
                return Ok(equal_weights(levels));
            }
            let weights: Vec<f64> = densities.iter().map(|d| libm::exp(d - highest)).collect();
            let sum: f64 = weights.iter().sum();
            Ok(levels
                .into_iter()
                .zip(weights)
                .map(|(m, w)| (m, w / sum))
                .collect())
        };
        (0..self.families.len()).map(weights).collect()
    }

    /// Returns the log-density of the blocks that share an unknown discrepancy, for each value of m.
    fn by_level(&self, family: usize, values: &[f64], theta: &[f64]) -> Result<Vec<f64>, LikelihoodError> {
        let levels = discrepancy_levels();
        let mut densities = vec![0.0; levels.len()];
        for block in self.blocks.iter().filter(|block| block.family == Some(family)) {
            let shift = self.common_shift(block, values, theta)?;
            for (density, &m) in densities.iter_mut().zip(&levels) {
                *density += match &shift {
                    Some(shift) => shift.log_density(self.law, m),
                    None => self.block_density(block, m, values, theta)?,
                };
            }
        }
        Ok(densities)
    }

    fn block_density(
        &self,
        block: &ErrorBlock,
        m: f64,
        values: &[f64],
        theta: &[f64],
    ) -> Result<f64, LikelihoodError> {
        let scored = self.score(block, m, values, theta)?;
        Ok(scored.map_or(f64::NEG_INFINITY, |s| {
            let log_determinant = s.factor.log_determinant();
            let density = self
                .law
                .log_density(block.data.len(), s.squared_distance, log_determinant);
            // A squared distance that overflows means a density of zero.
            if density.is_nan() {
                f64::NEG_INFINITY
            } else {
                density
            }
        }))
    }

    /// Factors a block; `None` where its covariance overflows.
    pub(super) fn score(
        &self,
        block: &ErrorBlock,
        m: f64,
        values: &[f64],
        theta: &[f64],
    ) -> Result<Option<ScoredBlock>, LikelihoodError> {
        let spread = self.spread(block, m, values, theta)?;
        Ok(CovarianceFactor::new(spread).map(|factor| {
            let residuals = block.data.iter().map(|&i| self.data[i].value - values[i]);
            let whitened = factor.whiten(residuals.collect());
            ScoredBlock {
                squared_distance: whitened.iter().map(|r| r * r).sum(),
                factor,
                whitened,
            }
        }))
    }

    /// Checks that there is one finite value for each datum and each derivative, else [`LikelihoodError::Length`] or
    /// [`LikelihoodError::Prediction`].
    pub fn check_values(&self, values: &[f64]) -> Result<(), LikelihoodError> {
        if values.len() != self.values() {
            return Err(LikelihoodError::Length {
                expected: self.values(),
                given: values.len(),
            });
        }
        let owners = (0..self.data.len()).chain(self.sensitive.iter().map(|sensitive| sensitive.datum));
        owners
            .zip(values)
            .try_for_each(|(i, &value)| self.data[i].check_prediction(value))
    }
}

/// Gives all levels the same probability.
fn equal_weights(levels: Vec<f64>) -> Vec<(f64, f64)> {
    let share = 1.0 / levels.len() as f64;
    levels.into_iter().map(|m| (m, share)).collect()
}

/// Computes `ln mean exp`; minus infinity if all values are.
fn log_mean_exp(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if let [only] = values {
        return *only;
    }
    if !highest.is_finite() {
        return highest;
    }
    let sum: f64 = values.iter().map(|v| libm::exp(v - highest)).sum();
    highest + libm::log(sum / values.len() as f64)
}
