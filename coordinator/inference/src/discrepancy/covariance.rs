//! The covariance of the discrepancies of two conditions.

use nalgebra::{Cholesky, DMatrix, Dyn};

use super::misfit::Misfit;
use crate::gaussian_process::matern;

/// The covariance of a discrepancy; coordinates over their range.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Covariance {
    /// Standard deviation of the smooth part.
    pub(super) sd: f64,
    /// Standard deviation of the local part of each condition.
    pub(super) local_sd: f64,
    /// Correlation of two groups in the same condition.
    pub(super) between_groups: f64,
    pub(super) lengths: Vec<f64>,
}

impl Covariance {
    /// Returns the covariance of the smooth parts of two conditions.
    pub(super) fn between(&self, a: (&[f64], usize), b: (&[f64], usize)) -> f64 {
        let groups = if a.1 == b.1 { 1.0 } else { self.between_groups };
        self.sd * self.sd * groups * matern(a.0, b.0, &self.lengths)
    }

    /// Returns the factor of the covariance of misfits, noise included; `None` where it is singular to rounding.
    pub(super) fn factor(&self, misfits: &[Misfit]) -> Option<Cholesky<f64, Dyn>> {
        let n = misfits.len();
        let mut matrix = DMatrix::zeros(n, n);
        for (i, a) in misfits.iter().enumerate() {
            for (j, b) in misfits.iter().enumerate().take(i + 1) {
                matrix[(i, j)] = self.between((&a.point, a.group), (&b.point, b.group));
            }
            matrix[(i, i)] += self.local_sd * self.local_sd + a.noise_variance;
        }
        // The factorisation reads the lower triangle alone.
        Cholesky::new(matrix)
    }
}
