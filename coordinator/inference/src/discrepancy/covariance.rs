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
    /// Standard deviation of the value of a plane in the middle of the ranges and of each of its slopes; 0 without a plane.
    pub(super) plane_sd: f64,
}

impl Covariance {
    /// Returns the covariance of the smooth parts of two conditions, the plane included, which all groups share.
    pub(super) fn between(&self, a: (&[f64], usize), b: (&[f64], usize)) -> f64 {
        let groups = if a.1 == b.1 { 1.0 } else { self.between_groups };
        let smooth = self.sd * self.sd * groups * matern(a.0, b.0, &self.lengths);
        if self.plane_sd == 0.0 {
            return smooth;
        }
        let slopes: f64 = a.0.iter().zip(b.0).map(|(x, y)| (x - 0.5) * (y - 0.5)).sum();
        smooth + self.plane_sd * self.plane_sd * (1.0 + slopes)
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
