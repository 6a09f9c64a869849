//! Report where a search ended, how it came there, and how sharply that is known.

use serde::{Deserialize, Serialize};

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StopReason {
    /// No step gains more than the tolerance.
    Decrease,
    /// Only steps below the tolerance are left, and none of those tried gained anything: as far as the model's noise
    /// lets one see.
    Step,
    /// The budget of evaluations is spent; a better point may be near.
    Budget,
    /// For many generations nobody was better than the best: the search that found it has settled.
    Stagnation,
    /// All generations have passed, and the best was still getting better; a better point may be near.
    Generations,
}

impl StopReason {
    /// Every reason.
    pub const ALL: [Self; 5] = [
        Self::Decrease,
        Self::Step,
        Self::Budget,
        Self::Stagnation,
        Self::Generations,
    ];

    /// Whether the search was cut short.
    #[must_use]
    pub fn is_early(self) -> bool {
        matches!(self, Self::Budget | Self::Generations)
    }

    /// The reason as a word: `decrease`, `step`, `budget`, `stagnation`, `generations`.
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

    /// The reason of a word.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stop| stop.name() == name)
    }
}

/// What the parabola around the most probable parameters says of their uncertainty.
///
/// Laplace's approximation (Tierney & Kadane 1986, J. Am. Stat. Assoc. 81:82): right for a normal posterior, checked
/// there by `lm::a_linear_model_with_normal_priors_has_its_closed_form`.
#[derive(Debug, Clone, PartialEq)]
pub struct Laplace {
    /// Standard deviation of each parameter, the others free; `None` at a bound and where nothing fixes it.
    pub sd: Vec<Option<f64>>,
    /// Covariance in the units of the parameters: the inverse of the curvature of f, the model's own curvature left out.
    /// Rows and columns of parameters without a standard deviation are 0.
    pub covariance: Vec<Vec<f64>>,
}

/// Where a search by generations stood after one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Generation {
    /// Evaluations so far.
    pub evaluations: u64,
    /// Highest log-posterior so far, in nats; `None` while the model rejected everything.
    pub best: Option<f64>,
    /// Mean log-posterior of the generation's evaluated individuals that the model took; `None` if it took none.
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
    /// Their uncertainty, where the search knows the curvature there.
    pub laplace: Option<Laplace>,
    /// Evaluations spent.
    pub evaluations: u64,
    /// Those that the model rejected.
    pub rejected: u64,
    /// Why the search ended.
    pub stop: StopReason,
    /// How a search by generations came there; empty for a search by steps.
    pub history: Vec<Generation>,
}

impl ModeEstimate {
    /// ln p(data | theta) + ln p(theta), in nats; without the evidence, which no such search knows.
    #[must_use]
    pub fn log_posterior(&self) -> f64 {
        self.log_likelihood + self.log_prior
    }

    /// Standard deviation of a parameter after Laplace.
    #[must_use]
    pub fn sd(&self, parameter: usize) -> Option<f64> {
        *self.laplace.as_ref()?.sd.get(parameter)?
    }
}
