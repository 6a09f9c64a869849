//! Hold the states of a population and what the outside sees of them.

use std::sync::Arc;

use super::metamodel::Pair;
use crate::log_likelihood::LogLikelihood;
use crate::prior::Prior;

/// A parameter vector with its log-likelihood and log-prior.
#[derive(Debug, Clone, PartialEq)]
pub struct Particle {
    /// The parameters, in the order of the prior.
    pub theta: Vec<f64>,
    /// ln p(data | theta).
    pub log_likelihood: LogLikelihood,
    /// ln p(theta).
    pub log_prior: f64,
}

/// A state in sampling coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    pub(super) coordinates: Vec<f64>,
    /// Log-density of the coordinates, Jacobian included.
    pub(super) log_prior: f64,
    pub(super) log_likelihood: LogLikelihood,
    /// What fine and coarse model say here, where a metamodel is to learn from it.
    pub(super) pair: Option<Arc<Pair>>,
}

impl State {
    pub(super) fn particle(&self, prior: &Prior) -> Particle {
        let theta = prior.theta(&self.coordinates);
        let log_prior = prior.log_density(&theta);
        Particle {
            theta,
            log_likelihood: self.log_likelihood,
            log_prior,
        }
    }
}

/// States that share one target density, each from one of several chains.
///
/// Every log-likelihood is finite.
#[derive(Debug, Clone, Default)]
pub(super) struct Pool {
    pub(super) states: Vec<State>,
    /// The chain of each state.
    pub(super) chains: Vec<usize>,
}

impl Pool {
    pub(super) fn push(&mut self, chain: usize, state: State) {
        self.chains.push(chain);
        self.states.push(state);
    }

    pub(super) fn log_likelihoods(&self) -> Vec<f64> {
        self.states
            .iter()
            .map(|state| state.log_likelihood.value())
            .collect()
    }
}
