//! Describe what is known of the parameters before the measurements.

mod distribution;
mod error;
mod marginal;
mod moments;
mod normal;

pub use distribution::Distribution;
pub use error::PriorError;
pub use marginal::Marginal;
pub(crate) use normal::LN_SQRT_TAU;

use serde::{Deserialize, Serialize};

use crate::rng::Stream;

/// Independent marginals, one per parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Prior {
    marginals: Vec<Marginal>,
}

impl Prior {
    /// The product of the marginals, in the order of theta.
    #[must_use]
    pub fn new(marginals: Vec<Marginal>) -> Self {
        Self { marginals }
    }

    /// The marginals, in the order of theta.
    #[must_use]
    pub fn marginals(&self) -> &[Marginal] {
        &self.marginals
    }

    /// The number of parameters.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.marginals.len()
    }

    /// ln p(theta); minus infinity outside the support and for a vector of the wrong length.
    #[must_use]
    pub fn log_density(&self, theta: &[f64]) -> f64 {
        if theta.len() != self.marginals.len() {
            return f64::NEG_INFINITY;
        }
        self.marginals
            .iter()
            .zip(theta)
            .map(|(marginal, &x)| marginal.log_density(x))
            .sum()
    }

    /// One independent draw of theta.
    pub fn sample(&self, stream: &mut Stream) -> Vec<f64> {
        self.marginals
            .iter()
            .map(|marginal| marginal.sample(stream))
            .collect()
    }

    /// Log-density of sampling coordinates, Jacobian included; minus infinity outside the support.
    pub(crate) fn log_density_of_coordinates(&self, coordinates: &[f64]) -> f64 {
        self.marginals
            .iter()
            .zip(coordinates)
            .map(|(marginal, &u)| marginal.log_density_of_coordinate(u))
            .sum()
    }

    /// Sampling coordinates of theta.
    pub(crate) fn coordinates(&self, theta: &[f64]) -> Vec<f64> {
        self.marginals
            .iter()
            .zip(theta)
            .map(|(marginal, &x)| marginal.coordinate(x))
            .collect()
    }

    /// Theta of sampling coordinates.
    pub(crate) fn theta(&self, coordinates: &[f64]) -> Vec<f64> {
        self.marginals
            .iter()
            .zip(coordinates)
            .map(|(marginal, &u)| marginal.value(u))
            .collect()
    }
}
