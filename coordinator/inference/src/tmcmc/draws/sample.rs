//! Draws of one proposal, with their importance weights at any tempering exponent.

use crate::tmcmc::pool::{ChainState, Pool};
use crate::tmcmc::transition::systematic;

/// Draws of one proposal. A draw that the model rejected has no weight at any exponent.
#[derive(Debug, Clone, Default)]
pub(crate) struct WeightedSample {
    pub(crate) states: Vec<ChainState>,
    /// ln (prior density / proposal density) of each draw.
    pub(crate) log_ratios: Vec<f64>,
}

/// The importance weights of a sample at one exponent.
#[derive(Debug, Clone)]
pub(crate) struct ImportanceWeights {
    pub(crate) normalised: Vec<f64>,
    /// ln of the mean weight: ln Z.
    pub(crate) log_mean: f64,
    /// Effective sample size `1 / sum w^2` (Kong).
    pub(crate) ess: f64,
}

/// The mean of the log-likelihood under a target, with its variance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Expectation {
    pub(crate) mean: f64,
    pub(crate) variance: f64,
}

impl ImportanceWeights {
    /// Normalises weights; `None` without a positive one, or if a weight is no number.
    pub(crate) fn new(log_weights: &[f64]) -> Option<Self> {
        let largest = log_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if !largest.is_finite() {
            return None;
        }
        let mut normalised: Vec<f64> = log_weights.iter().map(|w| libm::exp(w - largest)).collect();
        let sum: f64 = normalised.iter().sum();
        if !sum.is_finite() {
            return None;
        }
        for weight in &mut normalised {
            *weight /= sum;
        }
        let ess = 1.0 / normalised.iter().map(|w| w * w).sum::<f64>();
        let log_mean = largest + libm::log(sum / normalised.len() as f64);
        Some(Self {
            normalised,
            log_mean,
            ess,
        })
    }

    /// Returns the variance of `log_mean`, the relative variance of the mean weight.
    pub(crate) fn log_mean_variance(&self) -> f64 {
        let count = self.normalised.len() as f64;
        (count / self.ess - 1.0).max(0.0) / count
    }

    /// Returns the effective sample size over the number of draws, ESS/N.
    pub(crate) fn share(&self) -> f64 {
        self.ess / self.normalised.len() as f64
    }

    /// Returns the coefficient of variation.
    pub(crate) fn cov(&self) -> f64 {
        (1.0 / self.share() - 1.0).max(0.0).sqrt()
    }
}

impl WeightedSample {
    pub(crate) fn push(&mut self, state: ChainState, log_ratio: f64) {
        self.states.push(state);
        self.log_ratios.push(log_ratio);
    }

    #[cfg(test)]
    pub(crate) fn push_evaluated(&mut self, coordinates: Vec<f64>, log_likelihood: f64) {
        let state = ChainState {
            coordinates,
            log_prior: 0.0,
            log_likelihood: statistics::LogLikelihood::new(log_likelihood)
                .unwrap_or(statistics::LogLikelihood::Impossible),
        };
        self.push(state, 0.0);
    }

    /// Returns ln of the weights at an exponent.
    pub(crate) fn log_weights(&self, exponent: f64) -> Vec<f64> {
        let pairs = self.states.iter().zip(&self.log_ratios);
        pairs
            .map(|(state, log_ratio)| {
                if state.log_likelihood.is_impossible() {
                    f64::NEG_INFINITY
                } else {
                    exponent * state.log_likelihood.value() + log_ratio
                }
            })
            .collect()
    }

    /// Returns the weights at an exponent; `None` if every draw was rejected, or a weight is no number.
    pub(crate) fn weights(&self, exponent: f64) -> Option<ImportanceWeights> {
        ImportanceWeights::new(&self.log_weights(exponent))
    }

    /// Returns the share of the draws that the model did not reject.
    pub(crate) fn possible(&self) -> f64 {
        let possible = self
            .states
            .iter()
            .filter(|state| !state.log_likelihood.is_impossible());
        possible.count() as f64 / self.states.len() as f64
    }

    /// Returns the mean log-likelihood under the target of these weights: `sum w l`, with variance `sum w^2 (l - mean)^2`.
    pub(crate) fn mean_log_likelihood(&self, weights: &ImportanceWeights) -> Expectation {
        let terms = || {
            let pairs = self.states.iter().zip(&weights.normalised);
            pairs
                .filter(|(state, _)| !state.log_likelihood.is_impossible())
                .map(|(state, weight)| (state.log_likelihood.value(), weight))
        };
        let mean: f64 = terms().map(|(l, weight)| weight * l).sum();
        let deviations = terms().map(|(l, weight)| weight * (l - mean));
        Expectation {
            mean,
            variance: deviations.map(|d| d * d).sum(),
        }
    }

    /// Returns a sample of equal weights, by systematic resampling; copies of one draw belong to one chain.
    pub(crate) fn resampled(&self, weights: &ImportanceWeights, count: usize, tooth: f64) -> Pool {
        let mut pool = Pool::default();
        for index in systematic(&weights.normalised, count, tooth) {
            pool.push(index, self.states[index].clone());
        }
        pool
    }
}
