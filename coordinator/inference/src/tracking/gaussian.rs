//! The distribution of one filter: normal in the scores of the prior.

use nalgebra::{DMatrix, DVector};

/// A normal distribution of the scores.
#[derive(Debug, Clone)]
pub(super) struct Gaussian {
    pub(super) mean: DVector<f64>,
    pub(super) covariance: DMatrix<f64>,
}

impl Gaussian {
    /// Returns the mean and covariance of draws, each a vector of scores.
    pub(super) fn of_draws(draws: &[Vec<f64>], dimension: usize) -> Self {
        let count = draws.len().max(2) as f64;
        let mean = DVector::from_fn(dimension, |i, _| draws.iter().map(|d| d[i]).sum::<f64>() / count);
        let covariance = DMatrix::from_fn(dimension, dimension, |i, j| {
            let products = draws.iter().map(|d| (d[i] - mean[i]) * (d[j] - mean[j]));
            products.sum::<f64>() / (count - 1.0)
        });
        Gaussian { mean, covariance }
    }

    /// Lets some scores walk for a time.
    ///
    /// # Arguments
    /// - `varying`: positions of the scores. `prior`: covariance of all scores by the prior. `variance`: of the walk, below 1.
    pub(super) fn walk(&mut self, varying: &[usize], prior: &DMatrix<f64>, variance: f64) {
        let kept = (1.0 - variance).sqrt();
        for &i in varying {
            self.mean[i] *= kept;
            self.covariance.row_mut(i).scale_mut(kept);
            self.covariance.column_mut(i).scale_mut(kept);
        }
        for &i in varying {
            for &j in varying {
                self.covariance[(i, j)] += variance * prior[(i, j)];
            }
        }
    }

    /// Draws some scores anew: they have the prior, independent of the others, which stay.
    pub(super) fn renewed(&self, varying: &[usize], prior: &DMatrix<f64>) -> Self {
        let mut renewed = self.clone();
        for &i in varying {
            renewed.mean[i] = 0.0;
            renewed.covariance.row_mut(i).fill(0.0);
            renewed.covariance.column_mut(i).fill(0.0);
        }
        for &i in varying {
            for &j in varying {
                renewed.covariance[(i, j)] = prior[(i, j)];
            }
        }
        renewed
    }

    /// Returns whether another distribution is nearly this one: no mean is off by half a standard deviation, and none of these has halved.
    pub(super) fn is_near(&self, other: &Self) -> bool {
        (0..self.mean.len()).all(|i| {
            let [mine, its] = [self, other].map(|of| of.covariance[(i, i)].sqrt());
            (self.mean[i] - other.mean[i]).abs() <= 0.5 * its && mine <= 2.0 * its
        })
    }
}
