//! Weights and learning rates as functions of dimension and population.
//!
//! Table 1 of Hansen 2016, arXiv:1604.00772, without negative weights.

/// Returns the default population for a dimension.
pub(super) fn default_population(dimension: usize) -> usize {
    4 + (3.0 * libm::log(dimension.max(1) as f64)) as usize
}

/// The constants of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rates {
    /// Weights of the better half, the best first; they sum to one.
    pub(super) weights: Vec<f64>,
    /// Variance effective selection mass, 1 / sum of the squared weights.
    pub(super) effective: f64,
    /// Learning rate of the path of the step size, and its damping.
    pub(super) sigma: f64,
    pub(super) damping: f64,
    /// Learning rate of the path of the covariance.
    pub(super) path: f64,
    /// Learning rate of the rank-one update.
    pub(super) rank_one: f64,
    /// Learning rate of the rank-mu update.
    pub(super) rank_mu: f64,
    /// Expected length of a standard normal vector.
    pub(super) length: f64,
}

impl Rates {
    pub(super) fn new(dimension: usize, population: usize) -> Self {
        let n = dimension as f64;
        let half = libm::log((population as f64 + 1.0) / 2.0);
        let raw: Vec<f64> = (1..=population / 2)
            .map(|rank| half - libm::log(rank as f64))
            .collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        let effective = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let sigma = (effective + 2.0) / (n + effective + 5.0);
        let rank_one = 2.0 / ((n + 1.3) * (n + 1.3) + effective);
        let gain = 2.0 * (0.25 + effective + 1.0 / effective - 2.0);
        let rank_mu = (gain / ((n + 2.0) * (n + 2.0) + effective)).min(1.0 - rank_one);
        Self {
            damping: 1.0 + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + sigma,
            path: (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n),
            length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
            weights,
            effective,
            sigma,
            rank_one,
            rank_mu,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_dimensions_have_the_tutorial_s_numbers() {
        assert_eq!(default_population(10), 10);
        let rates = Rates::new(10, 10);
        assert_eq!(rates.weights.len(), 5);
        assert!((rates.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        // w_i ~ ln 5.5 - ln i: 0.4563, 0.2708, 0.1622, 0.0852, 0.0255.
        assert!((rates.weights[0] - 0.4563).abs() < 1e-3 && (rates.effective - 3.167).abs() < 1e-2);
        // c_1 = 2 / (11.3^2 + mu_eff), c_c = (4 + mu_eff/n) / (n + 4 + 2 mu_eff/n).
        assert!((rates.rank_one - 2.0 / 130.86).abs() < 1e-4);
        assert!((rates.path - 4.3167 / 14.6333).abs() < 1e-3);
    }
}
