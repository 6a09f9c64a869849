//! One multivariate t-density of five degrees of freedom.

use nalgebra::{Cholesky, DMatrix};

/// Degrees of freedom: heavier tails than a normal density, with a finite covariance.
pub(super) const DEGREES_OF_FREEDOM: usize = 5;

/// Smallest diagonal entry of a correlation's factor: below this, rounding decides.
const MIN_PIVOT: f64 = 1e-7;

/// A weighted t-density.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Component {
    pub(super) weight: f64,
    pub(super) mean: Vec<f64>,
    /// Scatter matrix C, by rows.
    pub(super) scatter: Vec<f64>,
    /// L of C = L L', by rows.
    factor: Vec<f64>,
    /// 1 / L(i, i).
    inverse_diagonal: Vec<f64>,
    pub(super) log_root_determinant: f64,
}

impl Component {
    /// Factors the *correlation* of `scatter` and scales it back, so that a thin ridge keeps its shape. `None` if the
    /// scatter is singular to rounding.
    pub(super) fn new(weight: f64, mean: Vec<f64>, scatter: Vec<f64>) -> Option<Self> {
        let dimension = mean.len();
        let sd: Vec<f64> = (0..dimension)
            .map(|i| scatter[i * dimension + i].sqrt())
            .collect();
        if !sd.iter().all(|sd| sd.is_finite() && *sd > 0.0) {
            return None;
        }
        let correlation = DMatrix::from_fn(dimension, dimension, |row, column| {
            if row == column {
                1.0
            } else {
                scatter[row * dimension + column] / sd[row] / sd[column]
            }
        });
        let lower = Cholesky::new(correlation)?.unpack();
        if !(0..dimension).all(|i| lower[(i, i)] > MIN_PIVOT) {
            return None;
        }
        let mut factor = vec![0.0; dimension * dimension];
        let mut log_root_determinant = 0.0;
        for row in 0..dimension {
            for column in 0..=row {
                factor[row * dimension + column] = lower[(row, column)] * sd[row];
            }
            log_root_determinant += libm::log(factor[row * dimension + row]);
        }
        let inverse_diagonal = (0..dimension).map(|i| 1.0 / factor[i * dimension + i]).collect();
        Some(Self {
            weight,
            mean,
            scatter,
            factor,
            inverse_diagonal,
            log_root_determinant,
        })
    }

    /// Returns (x - m)' C^-1 (x - m).
    pub(super) fn square_distance(&self, x: &[f64], scratch: &mut Vec<f64>) -> f64 {
        let dimension = self.mean.len();
        scratch.clear();
        let mut sum = 0.0;
        for (row, x) in x.iter().enumerate() {
            let row_values = &self.factor[row * dimension..row * dimension + row];
            let mut value = x - self.mean[row];
            for (l, z) in row_values.iter().zip(scratch.iter()) {
                value -= l * z;
            }
            value *= self.inverse_diagonal[row];
            scratch.push(value);
            sum += value * value;
        }
        sum
    }

    /// Returns `(1 + s / nu)^(-(nu + d) / 2)` at the square distance s: the density without its constants, and without a
    /// logarithm.
    pub(super) fn kernel(&self, square_distance: f64) -> f64 {
        let base = 1.0 / (1.0 + square_distance / DEGREES_OF_FREEDOM as f64);
        let twice = DEGREES_OF_FREEDOM + self.mean.len();
        let mut power = if twice % 2 == 1 { base.sqrt() } else { 1.0 };
        for _ in 0..twice / 2 {
            power *= base;
        }
        power
    }

    /// Returns m + scale L z.
    pub(super) fn at(&self, normals: &[f64], scale: f64) -> Vec<f64> {
        let dimension = self.mean.len();
        (0..dimension)
            .map(|row| {
                let row_values = &self.factor[row * dimension..=row * dimension + row];
                let step: f64 = row_values.iter().zip(normals).map(|(l, z)| l * z).sum();
                self.mean[row] + scale * step
            })
            .collect()
    }
}

/// Returns ln of the constant of a t-density without its determinant.
pub(super) fn log_constant(dimension: usize) -> f64 {
    let (nu, d) = (DEGREES_OF_FREEDOM as f64, dimension as f64);
    libm::lgamma(0.5 * (nu + d)) - libm::lgamma(0.5 * nu) - 0.5 * d * libm::log(nu * std::f64::consts::PI)
}
