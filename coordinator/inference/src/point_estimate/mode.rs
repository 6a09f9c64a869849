//! The mode of the posterior: its place, its uncertainty, and the reason for which the optimisation stopped.

use serde::{Deserialize, Serialize};

use crate::tmcmc::Particle;

/// The reason for which an optimisation stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StopReason {
    /// No step can decrease f by more than the tolerance.
    Decrease,
    /// No trial improves f, and shorter steps are below the tolerance: the fit has reached the resolution of the model's noise.
    Step,
    /// The budget of evaluations is spent; a better point may be near.
    Budget,
    /// No improvement for many generations: converged.
    Stagnation,
    /// The evolution reached its maximum number of generations while the best still improved; a better point may be near.
    Generations,
}

impl StopReason {
    /// All reasons for which an optimisation stops.
    pub const ALL: [Self; 5] = [
        Self::Decrease,
        Self::Step,
        Self::Budget,
        Self::Stagnation,
        Self::Generations,
    ];

    /// Returns whether the optimisation stopped before convergence.
    #[must_use]
    pub fn is_early(self) -> bool {
        matches!(self, Self::Budget | Self::Generations)
    }

    /// Returns the reason as a word: `decrease`, `step`, `budget`, `stagnation`, `generations`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Decrease => "decrease",
            Self::Step => "step",
            Self::Budget => "budget",
            Self::Stagnation => "stagnation",
            Self::Generations => "generations",
        }
    }

    /// Returns the reason with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stop| stop.name() == name)
    }
}

/// The Laplace approximation: the uncertainty by the curvature at the mode.
///
/// # Validity
/// Exact for a normal posterior. Checked by `lm::a_linear_model_with_normal_priors_has_its_closed_form`.
///
/// # Source
/// Tierney & Kadane 1986, J. Am. Stat. Assoc. 81:82, doi:10.1080/01621459.1986.10478240.
#[derive(Debug, Clone, PartialEq)]
pub struct Laplace {
    /// Standard deviation of each parameter while the other parameters vary; `None` at a bound and where it is not determined.
    pub sd: Vec<Option<f64>>,
    /// Covariance in the units of the parameters: the inverse of the curvature of f, without the model's own curvature.
    /// Rows and columns of parameters without a standard deviation are 0.
    pub covariance: Vec<Vec<f64>>,
}

/// A normal density in place of the posterior, in the normal scores of the parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalApproximation {
    /// ln p(data) by Laplace's approximation, in nats.
    pub log_evidence: f64,
    /// Equally weighted draws. Their log-likelihoods are those of the linearised model.
    pub draws: Vec<Particle>,
}

/// The state of an evolution after a generation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Generation {
    /// Number of evaluations so far.
    pub evaluations: u64,
    /// Highest log-posterior so far, in nats; `None` while the model rejected everything.
    pub best: Option<f64>,
    /// Mean log-posterior of the generation's evaluated individuals that the model accepted; `None` if it accepted none.
    pub mean: Option<f64>,
}

/// The most probable parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeEstimate {
    /// The parameters, in the order of the prior.
    pub theta: Vec<f64>,
    /// ln p(data | theta), in nats.
    pub log_likelihood: f64,
    /// ln p(theta), the density of the parameters as declared, in nats.
    pub log_prior: f64,
    /// Whether each parameter lies exactly at a bound of its prior.
    pub at_bound: Vec<bool>,
    /// The uncertainty, if the algorithm knows the curvature.
    pub laplace: Option<Laplace>,
    /// Draws about the mode, if the algorithm gives any.
    pub approximation: Option<NormalApproximation>,
    /// Number of evaluations.
    pub evaluations: u64,
    /// Number of evaluations that the model rejected.
    pub rejected: u64,
    /// The reason for which the optimisation stopped.
    pub stop: StopReason,
    /// The generations of an evolution; empty for a fit by steps.
    pub history: Vec<Generation>,
}

impl ModeEstimate {
    /// Returns ln p(data | theta) + ln p(theta), in nats; without the evidence, which no point estimate knows.
    #[must_use]
    pub fn log_posterior(&self) -> f64 {
        self.log_likelihood + self.log_prior
    }

    /// Returns the standard deviation of a parameter by the Laplace approximation.
    #[must_use]
    pub fn sd(&self, parameter: usize) -> Option<f64> {
        *self.laplace.as_ref()?.sd.get(parameter)?
    }
}
