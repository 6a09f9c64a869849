//! A point of a fit: an evaluated position with its log posterior.

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::strength_prior;
use statistics::likelihood::Likelihood;
use statistics::log_likelihood::LogLikelihood;

/// A position with its predicted values and its negative log posterior.
#[derive(Debug, Clone)]
pub(crate) struct FitPoint {
    pub(crate) position: Vec<f64>,
    pub(crate) values: Vec<f64>,
    /// `-log-likelihood - ln prior` \[nats\]; [`strength_prior::penalty`] defines the prior.
    pub(crate) value: f64,
}

impl FitPoint {
    /// Evaluates a position; `None` where the likelihood is zero.
    pub(crate) fn new(
        frame: &NormalFrame,
        likelihood: &Likelihood,
        position: Vec<f64>,
        values: Vec<f64>,
    ) -> Option<Self> {
        let theta = frame.theta(&position);
        let Ok(LogLikelihood::Finite(nats)) = likelihood.log_likelihood(&values, &theta) else {
            return None;
        };
        Some(Self {
            value: strength_prior::penalty(frame, &position) - nats.get(),
            position,
            values,
        })
    }

    /// Returns `ln p(data | t)`.
    pub(crate) fn log_likelihood(&self, frame: &NormalFrame) -> f64 {
        strength_prior::penalty(frame, &self.position) - self.value
    }
}
