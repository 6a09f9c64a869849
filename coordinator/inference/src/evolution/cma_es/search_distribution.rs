//! The normal distribution that a generation is drawn from, and its update.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::rates::Rates;

/// N(mean, sigma^2 C) with its evolution paths.
#[derive(Debug, Clone)]
pub(super) struct SearchDistribution {
    pub(super) mean: DVector<f64>,
    pub(super) sigma: f64,
    covariance: DMatrix<f64>,
    /// C = axes diag(lengths^2) axes'.
    axes: DMatrix<f64>,
    lengths: DVector<f64>,
    path: DVector<f64>,
    sigma_path: DVector<f64>,
    updates: i32,
}

impl SearchDistribution {
    pub(super) fn new(mean: &[f64], sigma: f64) -> Self {
        let n = mean.len();
        Self {
            mean: DVector::from_column_slice(mean),
            sigma,
            covariance: DMatrix::identity(n, n),
            axes: DMatrix::identity(n, n),
            lengths: DVector::repeat(n, 1.0),
            path: DVector::zeros(n),
            sigma_path: DVector::zeros(n),
            updates: 0,
        }
    }

    /// Returns mean + sigma axes diag(lengths) z.
    pub(super) fn draw(&self, normals: &[f64]) -> Vec<f64> {
        let stretched = DVector::from_column_slice(normals).component_mul(&self.lengths);
        (&self.mean + &self.axes * stretched * self.sigma)
            .iter()
            .copied()
            .collect()
    }

    /// Returns the longest standard deviation along a coordinate.
    pub(super) fn widest(&self) -> f64 {
        let variances = (0..self.mean.len()).map(|k| self.covariance[(k, k)]);
        self.sigma * variances.fold(0.0, f64::max).sqrt()
    }

    /// Returns the longest over shortest principal axis, squared.
    pub(super) fn condition(&self) -> f64 {
        let ratio = self.lengths.max() / self.lengths.min();
        ratio * ratio
    }

    /// Returns the mean of the variances along the coordinates.
    pub(super) fn mean_variance(&self) -> f64 {
        self.sigma * self.sigma * self.covariance.trace() / self.mean.len() as f64
    }

    /// Moves and reshapes the distribution by its better draws, the best first; a draw that is `None` moves nothing.
    ///
    /// Eq. 41 to 47 of Hansen 2016, arXiv:1604.00772.
    pub(super) fn update(&mut self, rates: &Rates, better: &[Option<&[f64]>]) {
        let n = self.mean.len();
        let steps: Vec<(f64, DVector<f64>)> = rates
            .weights
            .iter()
            .zip(better)
            .filter_map(|(&weight, draw)| {
                let draw = DVector::from_column_slice((*draw)?);
                Some((weight, (draw - &self.mean) / self.sigma))
            })
            .collect();
        let mut shift = DVector::zeros(n);
        for (weight, step) in &steps {
            shift += step * *weight;
        }
        self.mean += &shift * self.sigma;
        // C^-1/2 shift.
        let mut white = self.axes.transpose() * &shift;
        white.component_div_assign(&self.lengths);
        let white = &self.axes * white;
        let kept = 1.0 - rates.sigma;
        let gain = (rates.sigma * (2.0 - rates.sigma) * rates.effective).sqrt();
        self.sigma_path = &self.sigma_path * kept + white * gain;
        let length = self.sigma_path.norm();
        self.updates = self.updates.saturating_add(1);
        let grown = (1.0 - libm::pow(kept, 2.0 * f64::from(self.updates))).sqrt();
        // A path that is long because the step size lags behind must not stretch the covariance.
        let stalled = length / grown >= (1.4 + 2.0 / (n as f64 + 1.0)) * rates.length;
        self.path *= 1.0 - rates.path;
        let path_variance = rates.path * (2.0 - rates.path);
        if !stalled {
            self.path += shift * (path_variance * rates.effective).sqrt();
        }
        let missing = if stalled { path_variance } else { 0.0 };
        let kept = 1.0 - rates.rank_one - rates.rank_mu + rates.rank_one * missing;
        self.covariance *= kept;
        self.covariance += &self.path * self.path.transpose() * rates.rank_one;
        for (weight, step) in &steps {
            self.covariance += step * step.transpose() * (rates.rank_mu * weight);
        }
        let change = rates.sigma / rates.damping * (length / rates.length - 1.0);
        self.sigma *= libm::exp(change.min(1.0));
        self.factor();
    }

    /// Factors the covariance; keeps the last factor where rounding or overflow leaves none.
    fn factor(&mut self) {
        self.covariance = (&self.covariance + self.covariance.transpose()) * 0.5;
        if self.covariance.iter().any(|x| !x.is_finite()) {
            return;
        }
        let eigen = SymmetricEigen::new(self.covariance.clone());
        if eigen.eigenvalues.iter().all(|&value| value > 0.0) {
            self.lengths = eigen.eigenvalues.map(f64::sqrt);
            self.axes = eigen.eigenvectors;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::rng::Stream;

    /// `f = 1/2 sum 10^(6 k / (n-1)) t_k^2`: the covariance becomes that of the inverse Hessian.
    #[test]
    fn the_covariance_learns_the_shape_of_an_ellipsoid() {
        let n = 4;
        let scale = |k: usize| libm::pow(10.0, 6.0 * k as f64 / (n - 1) as f64);
        let rates = Rates::new(n, 8);
        let mut distribution = SearchDistribution::new(&[1.0; 4], 0.5);
        for generation in 0..300 {
            let mut draws: Vec<(f64, Vec<f64>)> = (0..8)
                .map(|k| {
                    let draw = distribution.draw(&Stream::new(1, generation, k, 0).normals(n));
                    let f = draw.iter().enumerate().map(|(k, t)| scale(k) * t * t).sum();
                    (f, draw)
                })
                .collect();
            draws.sort_by(|a, b| a.0.total_cmp(&b.0));
            let better: Vec<Option<&[f64]>> = draws.iter().map(|(_, draw)| Some(draw.as_slice())).collect();
            distribution.update(&rates, &better);
        }
        assert!(distribution.mean.norm() < 1e-8, "{}", distribution.mean);
        let condition = distribution.condition();
        assert!((1e5..1e7).contains(&condition), "{condition:e}");
    }
}
