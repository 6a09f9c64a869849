//! The prior space: all parameters in units of their priors' widths.

use super::individual::Individual;
use crate::point_estimate::PriorAxis;
use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;
use statistics::rng::Stream;

/// A position nearer to a bound than this, in prior widths, is at the bound: rounding must not decide it.
const NEAR: f64 = 1e-9;

/// The support of a prior, with one axis for each parameter.
#[derive(Debug, Clone)]
pub(crate) struct PriorSpace {
    pub(crate) prior: Prior,
    axes: Vec<PriorAxis>,
}

impl PriorSpace {
    pub(crate) fn new(prior: Prior) -> Self {
        let marginals = prior.marginals().iter().enumerate();
        let axes = marginals
            .map(|(parameter, marginal)| PriorAxis::new(parameter, marginal))
            .collect();
        Self { prior, axes }
    }

    pub(crate) fn dimension(&self) -> usize {
        self.axes.len()
    }

    pub(crate) fn centre(&self) -> Vec<f64> {
        let mean: Vec<f64> = self.prior.marginals().iter().map(|m| m.mean()).collect();
        self.position(&mean)
    }

    pub(crate) fn draw(&self, stream: &mut Stream) -> Vec<f64> {
        self.position(&self.prior.sample(stream))
    }

    fn position(&self, theta: &[f64]) -> Vec<f64> {
        let pairs = self.axes.iter().zip(theta);
        pairs.map(|(axis, &x)| axis.position(x)).collect()
    }

    /// Returns the nearest position within the bounds; exactly at a bound where it is within [`NEAR`].
    pub(crate) fn inside(&self, position: &[f64]) -> Vec<f64> {
        let inside = |(axis, &t): (&PriorAxis, &f64)| {
            if t < axis.lower + NEAR {
                axis.lower
            } else if t > axis.upper - NEAR {
                axis.upper
            } else {
                t
            }
        };
        self.axes.iter().zip(position).map(inside).collect()
    }

    /// Returns the parameters at a position; exact at a bound.
    pub(crate) fn theta(&self, position: &[f64]) -> Vec<f64> {
        let pairs = self.axes.iter().zip(position);
        pairs.map(|(axis, &t)| axis.value(t)).collect()
    }

    /// Returns whether each coordinate of a position is at a bound.
    pub(crate) fn at_bound(&self, position: &[f64]) -> Vec<bool> {
        let pairs = self.axes.iter().zip(position);
        pairs.map(|(axis, &t)| axis.is_bound(t)).collect()
    }

    pub(crate) fn individual(
        &self,
        position: Vec<f64>,
        theta: Vec<f64>,
        log_likelihood: LogLikelihood,
    ) -> Individual {
        let log_prior = self.prior.log_density(&theta);
        Individual {
            position,
            theta,
            log_likelihood,
            log_prior,
        }
    }
}
