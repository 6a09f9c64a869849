//! An individual: an evaluated point of an evolution.

use std::cmp::Ordering;

use statistics::log_likelihood::LogLikelihood;

/// An evaluated point.
#[derive(Debug, Clone)]
pub(crate) struct Individual {
    /// Position along every axis, within the bounds.
    pub(crate) position: Vec<f64>,
    pub(crate) theta: Vec<f64>,
    pub(crate) log_likelihood: LogLikelihood,
    pub(crate) log_prior: f64,
}

impl Individual {
    /// Returns ln p(data | theta) + ln p(theta); minus infinity where the model rejected the parameters.
    pub(crate) fn log_posterior(&self) -> f64 {
        self.log_likelihood.value() + self.log_prior
    }

    pub(crate) fn is_possible(&self) -> bool {
        self.log_posterior() > f64::NEG_INFINITY
    }

    /// Returns the order of rank: the better first.
    pub(crate) fn rank(&self, rival: &Self) -> Ordering {
        rival.log_posterior().total_cmp(&self.log_posterior())
    }
}
