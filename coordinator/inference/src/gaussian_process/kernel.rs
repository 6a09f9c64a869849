//! Covariances of points and of observations.

use nalgebra::DMatrix;

use super::observation::Observation;

/// Prior variance of each coefficient of the plane, over that of the process about it: large, so that the data choose the plane.
const PLANE: f64 = 100.0;

/// Returns the correlation of the values at two points: `(1 + r + r^2 / 3) exp(-r)`, `r^2 = 5 sum_k ((x_k - y_k) / l_k)^2`
/// (Matérn, 5/2).
pub(crate) fn matern(a: &[f64], b: &[f64], lengths: &[f64]) -> f64 {
    let mut squares = 0.0;
    for ((x, y), length) in a.iter().zip(b).zip(lengths) {
        let distance = (x - y) / length;
        squares += distance * distance;
    }
    let r = (5.0 * squares).sqrt();
    (1.0 + r + r * r / 3.0) * libm::exp(-r)
}

/// A plane and a process about it of unit variance.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Kernel {
    pub(super) lengths: Vec<f64>,
    /// Variance of the noise of one measurement.
    pub(super) noise: f64,
}

impl Kernel {
    /// Returns the covariance of the values at two points, without noise.
    pub(super) fn covariance(&self, a: &[f64], b: &[f64]) -> f64 {
        let product: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
        PLANE * (1.0 + product) + matern(a, b, &self.lengths)
    }

    pub(super) fn matrix(&self, observations: &[Observation]) -> DMatrix<f64> {
        let n = observations.len();
        let mut matrix = DMatrix::zeros(n, n);
        for (i, a) in observations.iter().enumerate() {
            for (j, b) in observations.iter().enumerate().take(i + 1) {
                let value = self.covariance(&a.point, &b.point);
                (matrix[(i, j)], matrix[(j, i)]) = (value, value);
            }
            matrix[(i, i)] += self.noise / a.repeats as f64;
        }
        matrix
    }
}
