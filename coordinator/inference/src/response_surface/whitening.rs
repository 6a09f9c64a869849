//! `Whitening`: coordinates in which draws are uncorrelated, with mean 0 and standard deviation 1.

use nalgebra::{Cholesky, DMatrix};

use super::error::ResponseSurfaceError;
use crate::diagnostics::mean_and_covariance;

/// The smallest admissible share of a parameter's variance that the parameters before it leave.
const MIN_REMAINING_VARIANCE: f64 = 1e-12;
/// Relative rounding error of a mean of equal draws.
const ROUNDING: f64 = 1e-13;

/// Coordinates in which draws are uncorrelated: u = L⁻¹ (x − m), with their mean m and the Cholesky factor L of their covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct Whitening {
    mean: Vec<f64>,
    factor: DMatrix<f64>,
}

impl Whitening {
    /// Computes mean and factor of equally weighted draws.
    ///
    /// # Errors
    /// [`ResponseSurfaceError::TooFewDraws`] with fewer than two draws; [`ResponseSurfaceError::Dependent`] if a parameter is constant or a
    /// linear function of the parameters before it.
    pub fn new(draws: &[Vec<f64>]) -> Result<Self, ResponseSurfaceError> {
        let parameters = draws.first().map_or(0, Vec::len);
        let too_few = ResponseSurfaceError::TooFewDraws {
            parameters,
            draws: draws.len(),
            needed: 2,
        };
        let (mean, covariance) = mean_and_covariance(draws).ok_or(too_few)?;
        let dependent = ResponseSurfaceError::Dependent { parameters };
        let variances = covariance.diagonal();
        let factor = Cholesky::new(covariance).ok_or(dependent)?.unpack();
        // A comparison with NaN is false.
        let is_independent = |i: usize| {
            // Equal draws have a variance of the order of their rounding errors.
            let rounding = ROUNDING * mean[i];
            let remaining = factor[(i, i)] * factor[(i, i)];
            remaining > MIN_REMAINING_VARIANCE * variances[i] && variances[i] > rounding * rounding
        };
        if !(0..parameters).all(is_independent) {
            return Err(dependent);
        }
        Ok(Whitening { mean, factor })
    }

    /// Returns the mean of the draws.
    #[must_use]
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Returns the rows of the factor's lower triangle: row i has i + 1 numbers.
    #[must_use]
    pub fn factor_rows(&self) -> Vec<Vec<f64>> {
        let row = |i: usize| (0..=i).map(|j| self.factor[(i, j)]).collect();
        (0..self.mean.len()).map(row).collect()
    }

    /// Returns the whitened coordinates of a point, by forward substitution. Their length is the Mahalanobis distance from the mean.
    #[must_use]
    pub fn whitened(&self, point: &[f64]) -> Vec<f64> {
        let mut whitened: Vec<f64> = Vec::with_capacity(point.len());
        for (i, x) in point.iter().enumerate() {
            let before: f64 = (0..i).map(|j| self.factor[(i, j)] * whitened[j]).sum();
            whitened.push((x - self.mean[i] - before) / self.factor[(i, i)]);
        }
        whitened
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn correlated() -> Vec<Vec<f64>> {
        let base = [(1.0, 0.0), (-1.0, 0.3), (0.2, -1.1), (2.0, 0.9), (-0.7, -0.4)];
        base.map(|(a, b)| vec![3.0 + 2.0 * a, 1e6 * (0.9 * a + 0.1 * b)])
            .to_vec()
    }

    #[test]
    fn whitened_draws_are_uncorrelated_with_unit_variance() {
        let draws = correlated();
        let whitening = Whitening::new(&draws).unwrap();
        let whitened: Vec<Vec<f64>> = draws.iter().map(|draw| whitening.whitened(draw)).collect();
        let (mean, covariance) = mean_and_covariance(&whitened).unwrap();
        assert!(mean.iter().all(|m| m.abs() < 1e-12), "{mean:?}");
        let identity = DMatrix::identity(2, 2);
        assert!((covariance - identity).abs().max() < 1e-12);
        assert_eq!(
            whitening.factor_rows().iter().map(Vec::len).collect::<Vec<_>>(),
            [1, 2]
        );
    }

    #[test]
    fn dependent_parameters_are_refused() {
        let line: Vec<Vec<f64>> = (0..9).map(|k| vec![f64::from(k), 0.1 * f64::from(k)]).collect();
        let constant: Vec<Vec<f64>> = (0..9).map(|k| vec![f64::from(k), 0.1]).collect();
        for draws in [line, constant] {
            let error = Whitening::new(&draws).unwrap_err();
            assert_eq!(error, ResponseSurfaceError::Dependent { parameters: 2 });
        }
        assert!(Whitening::new(&[vec![1.0]]).is_err() && Whitening::new(&[]).is_err());
    }
}
