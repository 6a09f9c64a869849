//! The factor of the weighted covariance of a pool, also of a degenerate one.

use nalgebra::{Cholesky, DMatrix, SymmetricEigen};

/// The weighted mean and a matrix A with A A' = the weighted covariance.
#[derive(Debug, Clone)]
pub(crate) struct CovarianceFactor {
    mean: Vec<f64>,
    root: DMatrix<f64>,
    /// True if the root is lower triangular with a positive diagonal, so that it can be inverted.
    regular: bool,
}

impl CovarianceFactor {
    /// Factors the covariance of `states` with `weights` that sum to one.
    ///
    /// The *correlation* matrix is factored and scaled back by the standard deviations, so a ridge with an aspect of 1e-6
    /// keeps its shape; nothing is added to the diagonal. A correlation that is singular to rounding is factored through its
    /// eigenvectors: the factor then spans exactly the space of the states.
    pub(crate) fn new(states: &[&[f64]], weights: &[f64]) -> Self {
        let dimension = states.first().map_or(0, |state| state.len());
        let mut mean = vec![0.0; dimension];
        for (state, weight) in states.iter().zip(weights) {
            for (sum, x) in mean.iter_mut().zip(*state) {
                *sum += weight * x;
            }
        }
        let mut covariance = DMatrix::<f64>::zeros(dimension, dimension);
        for (state, weight) in states.iter().zip(weights) {
            for row in 0..dimension {
                let scaled = weight * (state[row] - mean[row]);
                for column in 0..=row {
                    covariance[(row, column)] += scaled * (state[column] - mean[column]);
                }
            }
        }
        let sd: Vec<f64> = (0..dimension).map(|i| covariance[(i, i)].sqrt()).collect();
        let correlation = DMatrix::from_fn(dimension, dimension, |row, column| {
            let scale = sd[row] * sd[column];
            if row == column {
                1.0
            } else if scale > 0.0 {
                covariance[(row.max(column), row.min(column))] / sd[row] / sd[column]
            } else {
                0.0
            }
        });
        let (mut root, regular) = match Cholesky::new(correlation.clone()) {
            Some(cholesky) => (cholesky.unpack(), sd.iter().all(|&sd| sd > 0.0)),
            None => (semidefinite_root(correlation), false),
        };
        for (row, sd) in sd.iter().enumerate() {
            for column in 0..dimension {
                root[(row, column)] *= sd;
            }
        }
        Self { root, mean, regular }
    }

    /// Returns the number of coordinates.
    pub(crate) fn dimension(&self) -> usize {
        self.root.nrows()
    }

    /// Computes A times `normals`.
    pub(crate) fn spread(&self, normals: &[f64]) -> Vec<f64> {
        (0..self.root.nrows())
            .map(|row| {
                normals
                    .iter()
                    .enumerate()
                    .map(|(column, z)| self.root[(row, column)] * z)
                    .sum()
            })
            .collect()
    }

    /// Returns mean + A z.
    pub(crate) fn colour(&self, whitened: &[f64]) -> Vec<f64> {
        self.spread(whitened)
            .iter()
            .zip(&self.mean)
            .map(|(step, mean)| mean + step)
            .collect()
    }

    /// Returns A^-1 (x - mean), the inverse of [`CovarianceFactor::colour`]; `None` if A is singular.
    pub(crate) fn whiten(&self, x: &[f64]) -> Option<Vec<f64>> {
        if !self.regular {
            return None;
        }
        let mut whitened = vec![0.0; x.len()];
        for row in 0..x.len() {
            let explained: f64 = (0..row)
                .map(|column| self.root[(row, column)] * whitened[column])
                .sum();
            whitened[row] = (x[row] - self.mean[row] - explained) / self.root[(row, row)];
        }
        Some(whitened)
    }
}

/// Returns V sqrt(max(lambda, 0)); zero if the correlation is not finite.
fn semidefinite_root(correlation: DMatrix<f64>) -> DMatrix<f64> {
    let dimension = correlation.nrows();
    if correlation.iter().any(|x| !x.is_finite()) {
        return DMatrix::zeros(dimension, dimension);
    }
    let eigen = SymmetricEigen::new(correlation);
    DMatrix::from_fn(dimension, dimension, |row, column| {
        eigen.eigenvectors[(row, column)] * eigen.eigenvalues[column].max(0.0).sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thin_ridge_keeps_its_thickness() {
        // x along the ridge, y = -10 x + thickness * (+-1): sd of y + 10 x is the thickness.
        let (length, thickness) = (1e9, 5e4);
        let states: Vec<Vec<f64>> = (0..64)
            .map(|i| {
                let x = length * (f64::from(i / 2) / 16.0 - 1.0);
                vec![x, -10.0 * x + if i % 2 == 0 { thickness } else { -thickness }]
            })
            .collect();
        let views: Vec<&[f64]> = states.iter().map(Vec::as_slice).collect();
        let factor = CovarianceFactor::new(&views, &[1.0 / 64.0; 64]);
        let across = |normals: &[f64]| {
            let step = factor.spread(normals);
            step[1] + 10.0 * step[0]
        };
        let sd = (across(&[1.0, 0.0]).powi(2) + across(&[0.0, 1.0]).powi(2)).sqrt();
        assert!((sd / thickness - 1.0).abs() < 1e-2, "{sd}");
    }

    #[test]
    fn a_singular_covariance_spans_the_space_of_the_states() {
        let states: [&[f64]; 3] = [&[1.0, 2.0, 5.0], &[2.0, 4.0, 5.0], &[3.0, 6.0, 5.0]];
        let factor = CovarianceFactor::new(&states, &[1.0 / 3.0; 3]);
        let step = factor.spread(&[0.3, -1.2, 0.8]);
        assert!(
            (step[1] - 2.0 * step[0]).abs() < 1e-7 && step[0].abs() > 0.0,
            "{step:?}"
        );
        assert!(step[2].abs() < 1e-12);
    }
}
