//! A particle: a member of the population.

use super::pool::ChainState;
use statistics::{LogLikelihood, Prior};

/// A parameter vector with its log-likelihood and log-prior.
#[derive(Debug, Clone, PartialEq)]
pub struct Particle {
    /// The parameters, in the order of the prior.
    pub theta: Vec<f64>,
    /// ln p(data | theta).
    pub log_likelihood: LogLikelihood,
    /// Log density of the prior, ln p(theta).
    pub log_prior: f64,
}

impl Particle {
    pub(super) fn new(state: &ChainState, prior: &Prior) -> Self {
        let theta = prior.theta(&state.coordinates);
        let log_prior = prior.log_density(&theta);
        Self {
            theta,
            log_likelihood: state.log_likelihood,
            log_prior,
        }
    }
}
