//! Stored result of a fit or a search by generations.

use inference::point_estimate::{Generation, StopReason};

/// The stored result of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimateRow {
    /// The most probable parameters.
    pub theta: Vec<f64>,
    /// Log-likelihood there.
    pub log_likelihood: f64,
    /// Log-density of the prior there.
    pub log_prior: f64,
    /// Standard deviations after Laplace; `None` at a bound, and where nothing fixes a parameter. A search by
    /// generations has none at all.
    pub sd: Option<Vec<Option<f64>>>,
    /// Whether each parameter lies at a bound of its prior.
    pub at_bound: Vec<bool>,
    /// Why the fit or the search stopped.
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
