//! An evaluated position.

use crate::laplace::coordinate::NormalFrame;
use statistics::likelihood::Likelihood;
use statistics::log_likelihood::LogLikelihood;

/// A position with its predicted values and its negative log posterior.
#[derive(Debug, Clone)]
pub(crate) struct FitPoint {
    pub(crate) position: Vec<f64>,
    pub(crate) values: Vec<f64>,
    /// `-log-likelihood + |t|^2/2`, in nats.
    pub(crate) value: f64,
}

impl FitPoint {
    /// `None` where the likelihood is zero.
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
        let squares: f64 = position.iter().map(|t| t * t).sum();
        Some(Self {
            value: 0.5 * squares - nats.get(),
            position,
            values,
        })
    }

    /// ln p(data | t).
    pub(crate) fn log_likelihood(&self) -> f64 {
        let squares: f64 = self.position.iter().map(|t| t * t).sum();
        0.5 * squares - self.value
    }
}
