//! A block whose data share one shift, for all values of an unknown discrepancy at once.

use super::common_error::{CommonErrorSize, Discrepancy, ErrorBlock};
use super::datum::LikelihoodError;
use super::error_model::Likelihood;
use super::law::ErrorLaw;

/// The sums that give the density of a block with the covariance `diag(d^2) + (m u)^2 1 1'` for any m.
#[derive(Debug, Clone, Copy)]
pub(super) struct CommonShift {
    count: usize,
    /// Log-determinant of the noise, `sum ln d_i^2`.
    log_determinant: f64,
    /// `u^2 sum 1 / d_i^2`.
    information: f64,
    /// `sum (r_i - mean)^2 / d_i^2` about the mean that is weighted by `1 / d_i^2`.
    scatter: f64,
    /// `mean^2 sum 1 / d_i^2`.
    offset: f64,
}

impl CommonShift {
    /// Returns the share of the information along the shift's direction that remains with a discrepancy of the size m.
    pub(super) fn kept(&self, m: f64) -> f64 {
        1.0 / (1.0 + m * m * self.information)
    }

    /// Returns the log-density of the block; minus infinity where a sum overflows.
    ///
    /// `ln det S = sum ln d_i^2 + ln(1 + m^2 u^2 w)` and `r' S^-1 r = sum (r_i - mean)^2 / d_i^2 + mean^2 w / (1 + m^2 u^2 w)` with
    /// `w = sum 1 / d_i^2`.
    ///
    /// # Source
    /// Sherman & Morrison 1950, doi:10.1214/aoms/1177729893. Checked by `a_common_shift_has_the_density_of_its_covariance`.
    pub(super) fn log_density(&self, law: ErrorLaw, m: f64) -> f64 {
        let stretch = m * m * self.information;
        let density = law.log_density(
            self.count,
            self.scatter + self.offset / (1.0 + stretch),
            self.log_determinant + libm::log1p(stretch),
        );
        if density.is_nan() {
            f64::NEG_INFINITY
        } else {
            density
        }
    }
}

impl Likelihood {
    /// Returns the sums of a block with an unknown discrepancy and no other common error; `None` for any other block.
    pub(super) fn common_shift(
        &self,
        block: &ErrorBlock,
        values: &[f64],
        theta: &[f64],
    ) -> Result<Option<CommonShift>, LikelihoodError> {
        let [only] = block.common[..] else { return Ok(None) };
        let CommonErrorSize::Discrepancy { group } = self.common[only].size else {
            return Ok(None);
        };
        if self.discrepancies[group] != Discrepancy::Unknown {
            return Ok(None);
        }
        let (mut squares, mut log_determinant, mut weights, mut mean) = (0.0, 0.0, 0.0, 0.0);
        for &i in &block.data {
            let sd = self.data[i].noise_sd(theta)?;
            squares += sd * sd;
            log_determinant += libm::log(sd * sd);
            weights += 1.0 / (sd * sd);
            mean += (self.data[i].value - values[i]) / (sd * sd);
        }
        mean /= weights;
        let mut scatter = 0.0;
        for &i in &block.data {
            let apart = (self.data[i].value - values[i] - mean) / self.data[i].noise_sd(theta)?;
            scatter += apart * apart;
        }
        Ok(Some(CommonShift {
            count: block.data.len(),
            log_determinant,
            information: squares / block.data.len() as f64 * weights,
            scatter,
            offset: mean * mean * weights,
        }))
    }
}
