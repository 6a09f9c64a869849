//! The pool of a stage: the evaluated states of its chains.

use statistics::log_likelihood::LogLikelihood;

/// A state in sampling coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ChainState {
    /// Sampling coordinates, in the order of theta.
    pub(crate) coordinates: Vec<f64>,
    /// Log-density of the coordinates, Jacobian included.
    pub(crate) log_prior: f64,
    /// ln p(data | theta).
    pub(crate) log_likelihood: LogLikelihood,
}

/// States with one target density, from several chains. Every log-likelihood is finite.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pool {
    /// The states, in the order of their visits.
    pub(crate) states: Vec<ChainState>,
    /// The chain of each state.
    pub(crate) chains: Vec<usize>,
}

impl Pool {
    /// Adds a state of a chain.
    pub(crate) fn push(&mut self, chain: usize, state: ChainState) {
        self.chains.push(chain);
        self.states.push(state);
    }

    /// Returns the log-likelihood of each state.
    pub(crate) fn log_likelihoods(&self) -> Vec<f64> {
        self.states
            .iter()
            .map(|state| state.log_likelihood.value())
            .collect()
    }
}
