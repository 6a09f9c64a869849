//! The spread of a block's errors: their covariance from the noise of each datum and the common errors.

use super::common_error::{CommonError, CommonErrorSize, Discrepancy, ErrorBlock, Sensitive};
use super::datum::{Datum, LikelihoodError};
use super::error_model::Likelihood;

/// The levels of m, with weights, for a block without an unknown m.
pub(super) const CERTAIN: [(f64, f64); 1] = [(0.0, 1.0)];

/// The errors of a block, with the covariance `diag(sds^2) + sum v v'`.
pub(super) struct Spread {
    /// Noise sds, in the order of the block's data.
    pub(super) sds: Vec<f64>,
    /// Each v as a list of (position in the block, value).
    pub(super) common: Vec<Vec<(usize, f64)>>,
}

impl Likelihood {
    /// Returns whether a datum has no common error.
    #[must_use]
    pub fn is_alone(&self, datum: usize) -> bool {
        self.alone.binary_search(&datum).is_ok()
    }

    /// Returns the variance of each datum's error, noise and common errors; for an unknown discrepancy the mean over
    /// its values, weighted by their posterior probabilities.
    ///
    /// # Arguments
    /// As for [`Likelihood::log_likelihood`].
    ///
    /// # Returns
    /// The diagonal of the covariance [squared unit of the datum], in the order of the data; under Student's t that of
    /// the scale matrix.
    ///
    /// # Errors
    /// As for [`Likelihood::log_likelihood`]. Checked by `likelihood::variances_are_the_diagonal_of_the_covariance`.
    pub fn error_variances(&self, values: &[f64], theta: &[f64]) -> Result<Vec<f64>, LikelihoodError> {
        self.check_values(values)?;
        let mut variances = vec![0.0; self.data.len()];
        for &i in &self.alone {
            let sd = self.data[i].noise_sd(theta)?;
            variances[i] = sd * sd;
        }
        let families = self.family_weights(values, theta)?;
        for block in &self.blocks {
            let levels = block.family.map_or(&CERTAIN[..], |family| &families[family]);
            for &(m, probability) in levels {
                let Spread { sds, common } = self.spread(block, m, values, theta)?;
                for (i, sd) in block.data.iter().zip(sds) {
                    variances[*i] += probability * sd * sd;
                }
                for (position, v) in common.into_iter().flatten() {
                    variances[block.data[position]] += probability * v * v;
                }
            }
        }
        Ok(variances)
    }

    /// Returns the log-density of each datum on its own, marginalised over the errors of the others.
    ///
    /// # Arguments
    /// As for [`Likelihood::log_likelihood`].
    ///
    /// # Returns
    /// One log-density for each datum, in order; without common errors they sum to the log-likelihood.
    ///
    /// # Errors
    /// As for [`Likelihood::log_likelihood`]. Checked by `likelihood::densities_of_single_data_are_those_of_their_variances`.
    pub fn log_densities(&self, values: &[f64], theta: &[f64]) -> Result<Vec<f64>, LikelihoodError> {
        let variances = self.error_variances(values, theta)?;
        let density = |((datum, value), variance): ((&Datum, &f64), f64)| {
            let residual = datum.value - value;
            self.law
                .log_density(1, residual * residual / variance, libm::log(variance))
        };
        Ok(self.data.iter().zip(values).zip(variances).map(density).collect())
    }

    /// Returns the errors of a block for one value of its unknown m.
    pub(super) fn spread(
        &self,
        block: &ErrorBlock,
        m: f64,
        values: &[f64],
        theta: &[f64],
    ) -> Result<Spread, LikelihoodError> {
        let mut sds = Vec::with_capacity(block.data.len());
        for &i in &block.data {
            sds.push(self.data[i].noise_sd(theta)?);
        }
        let position = |i: &usize| block.data.binary_search(i).unwrap_or_default();
        let mut common = Vec::with_capacity(block.common.len());
        for &c in &block.common {
            let CommonError { data, size } = &self.common[c];
            let error: Vec<(usize, f64)> = match size {
                CommonErrorSize::Shift(sd) => {
                    let sd = sd.value(theta)?;
                    data.iter().map(|i| (position(i), sd)).collect()
                }
                CommonErrorSize::Discrepancy { group } => {
                    let m = match self.discrepancies[*group] {
                        Discrepancy::None => 0.0,
                        Discrepancy::Known(m) => m,
                        Discrepancy::Unknown => m,
                    };
                    let squares: f64 = data.iter().map(|i| sds[position(i)] * sds[position(i)]).sum();
                    let shift = m * (squares / data.len() as f64).sqrt();
                    data.iter().map(|i| (position(i), shift)).collect()
                }
                CommonErrorSize::Sensitivity { sd, derivative } => {
                    let sd = sd.value(theta)?;
                    let derivative = *derivative;
                    let shift = |&datum: &usize| sd * values[self.place(Sensitive { derivative, datum })];
                    data.iter().map(|i| (position(i), shift(i))).collect()
                }
                CommonErrorSize::Innovation(innovation) => {
                    data.iter().map(position).zip(innovation.shifts(theta)?).collect()
                }
            };
            common.push(error);
        }
        Ok(Spread { sds, common })
    }
}
