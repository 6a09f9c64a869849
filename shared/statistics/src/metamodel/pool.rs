//! The pool of a stage: evaluated states, with the predictions of both models.

use std::sync::Arc;

use crate::log_likelihood::LogLikelihood;

/// The predictions of both models at one parameter vector.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelPair {
    /// Predicted values of the fine model.
    pub fine: Vec<f64>,
    /// Predicted values of the coarse model.
    pub coarse: Vec<f64>,
}

/// A state in sampling coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainState {
    /// Sampling coordinates, in the order of theta.
    pub coordinates: Vec<f64>,
    /// Log-density of the coordinates, Jacobian included.
    pub log_prior: f64,
    /// ln p(data | theta).
    pub log_likelihood: LogLikelihood,
    /// The predictions of both models, if a metamodel learns from them.
    pub pair: Option<Arc<ModelPair>>,
}

/// States with one target density, from several chains. Every log-likelihood is finite.
#[derive(Debug, Clone, Default)]
pub struct Pool {
    /// The states, in the order of their visits.
    pub states: Vec<ChainState>,
    /// The chain of each state.
    pub chains: Vec<usize>,
}

impl Pool {
    /// Adds a state of a chain.
    pub fn push(&mut self, chain: usize, state: ChainState) {
        self.chains.push(chain);
        self.states.push(state);
    }

    /// Returns the log-likelihood of each state.
    #[must_use]
    pub fn log_likelihoods(&self) -> Vec<f64> {
        self.states
            .iter()
            .map(|state| state.log_likelihood.value())
            .collect()
    }
}
