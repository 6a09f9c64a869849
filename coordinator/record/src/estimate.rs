//! Stored result of a fit or of a search by generations.

use inference::point_estimate::{Generation, StopReason};

/// The stored result of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimateRow {
    /// The most probable parameters.
    pub theta: Vec<f64>,
    /// Log-likelihood at these parameters.
    pub log_likelihood: f64,
    /// Log-density of the prior at these parameters.
    pub log_prior: f64,
    /// Standard deviations by Laplace's approximation; `None` at a bound, for an undetermined parameter, and after a search by generations.
    pub sd: Option<Vec<Option<f64>>>,
    /// Whether each parameter lies at a bound of its prior.
    pub at_bound: Vec<bool>,
    /// Reason for which the fit or the search stopped.
    pub stop: StopReason,
    /// Convergence of a search by generations.
    pub history: Vec<Generation>,
}

impl EstimateRow {
    /// Log-likelihood plus log-density of the prior.
    #[must_use]
    pub fn log_posterior(&self) -> f64 {
        self.log_likelihood + self.log_prior
    }
}
