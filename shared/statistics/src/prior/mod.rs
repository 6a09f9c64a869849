//! The prior of the parameters.
//!
//! # Layout
//! - This file: [`Prior`]. `marginal`: one parameter, truncated. `correlation`: jointly normal parameters.
//! - `distribution`: the distributions. `density`: densities and quantiles in the sampling coordinate.
//! - `moments`, `normal`, `bound`: quadrature, the standard normal, nearness to a bound. `error`: errors.

mod bound;
mod correlation;
mod density;
mod distribution;
mod error;
mod marginal;
mod moments;
pub mod normal;

pub use correlation::CorrelationSlopes;
pub use distribution::Distribution;
pub use error::PriorError;
pub use marginal::Marginal;
pub use normal::LN_SQRT_TAU;

use crate::rng::Stream;
use correlation::Correlation;

/// One marginal per parameter; independent, except for parameters that are jointly normal.
#[derive(Debug, Clone, PartialEq)]
pub struct Prior {
    marginals: Vec<Marginal>,
    correlation: Option<Correlation>,
}

impl Prior {
    /// Creates the product of the marginals, in the order of theta.
    #[must_use]
    pub fn new(marginals: Vec<Marginal>) -> Self {
        Self {
            marginals,
            correlation: None,
        }
    }

    /// Adds correlations between some parameters, whose marginals must be normal in their sampling coordinates and
    /// untruncated; they are then jointly normal in these coordinates.
    ///
    /// # Arguments
    /// - `parameters`: ascending positions in theta. `correlations`: one row for each, symmetric, 1 on the diagonal.
    ///
    /// # Errors
    /// [`PriorError::NotNormal`] for any other marginal; [`PriorError::NotACorrelation`] for a matrix that is not positive
    /// definite, or of another size. Checked by `priors::correlated_parameters_have_the_closed_form`.
    pub fn correlated(self, parameters: Vec<usize>, correlations: &[Vec<f64>]) -> Result<Self, PriorError> {
        let correlation = Correlation::new(&self.marginals, parameters, correlations)?;
        Ok(Self {
            correlation: Some(correlation),
            ..self
        })
    }

    /// Returns the marginals, in the order of theta.
    #[must_use]
    pub fn marginals(&self) -> &[Marginal] {
        &self.marginals
    }

    /// Returns the number of parameters.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.marginals.len()
    }

    /// Returns ln p(theta); minus infinity outside the support and for a vector of the wrong length.
    #[must_use]
    pub fn log_density(&self, theta: &[f64]) -> f64 {
        if theta.len() != self.marginals.len() {
            return f64::NEG_INFINITY;
        }
        let independent: f64 = self
            .marginals
            .iter()
            .zip(theta)
            .map(|(marginal, &x)| marginal.log_density(x))
            .sum();
        self.with_correlation(independent, || self.coordinates(theta))
    }

    /// Adds the contribution of the correlations, inside the support.
    fn with_correlation(&self, independent: f64, coordinates: impl FnOnce() -> Vec<f64>) -> f64 {
        match &self.correlation {
            Some(correlation) if independent.is_finite() => {
                independent + correlation.log_density(&self.marginals, &coordinates())
            }
            _ => independent,
        }
    }

    /// Replaces the marginals' normal scores by independent ones: each correlated parameter given the preceding ones.
    pub fn make_independent(&self, scores: &mut [f64]) {
        if let Some(correlation) = &self.correlation {
            correlation.whiten(scores);
        }
    }

    /// Reverses [`Prior::make_independent`].
    pub fn make_dependent(&self, scores: &mut [f64]) {
        if let Some(correlation) = &self.correlation {
            correlation.colour(scores);
        }
    }

    /// Returns the marginal prior of some of the parameters: their marginals, and their correlations among themselves.
    ///
    /// # Arguments
    /// - `kept`: ascending positions in theta.
    #[must_use]
    pub fn subset(&self, kept: &[usize]) -> Self {
        let marginals: Vec<Marginal> = kept.iter().map(|&k| self.marginals[k].clone()).collect();
        let correlation = self.correlation.clone();
        let correlation = correlation.and_then(|correlation| correlation.subset(&marginals, kept));
        Self {
            marginals,
            correlation,
        }
    }

    /// Returns whether some parameters are correlated.
    #[must_use]
    pub fn is_correlated(&self) -> bool {
        self.correlation.is_some()
    }

    /// Draws a parameter vector theta from the prior.
    pub fn sample(&self, stream: &mut Stream) -> Vec<f64> {
        let mut theta: Vec<f64> = self
            .marginals
            .iter()
            .map(|marginal| marginal.sample(stream))
            .collect();
        if let Some(correlation) = &self.correlation {
            correlation.correlate(&self.marginals, &mut theta);
        }
        theta
    }

    /// Returns the contribution of the correlations to slope and curvature of -ln p at theta.
    pub fn slopes_of_correlation(&self, theta: &[f64]) -> CorrelationSlopes {
        self.correlation
            .as_ref()
            .map_or_else(CorrelationSlopes::default, |correlation| {
                correlation.slopes(&self.marginals, &self.coordinates(theta))
            })
    }

    /// Returns the log-density of sampling coordinates, Jacobian included; minus infinity outside the support.
    pub fn log_density_of_coordinates(&self, coordinates: &[f64]) -> f64 {
        let independent: f64 = self
            .marginals
            .iter()
            .zip(coordinates)
            .map(|(marginal, &u)| marginal.log_density_of_coordinate(u))
            .sum();
        self.with_correlation(independent, || coordinates.to_vec())
    }

    /// Returns the sampling coordinates of theta.
    pub fn coordinates(&self, theta: &[f64]) -> Vec<f64> {
        self.marginals
            .iter()
            .zip(theta)
            .map(|(marginal, &x)| marginal.coordinate(x))
            .collect()
    }

    /// Returns theta of sampling coordinates.
    pub fn theta(&self, coordinates: &[f64]) -> Vec<f64> {
        self.marginals
            .iter()
            .zip(coordinates)
            .map(|(marginal, &u)| marginal.value(u))
            .collect()
    }
}
