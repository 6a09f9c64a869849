//! Report where a fit ended, and how sharply.

use nalgebra::{Cholesky, DMatrix};

use super::objective::{Column, Objective, Point};

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// No step gains more than the tolerance.
    Decrease,
    /// Only steps below the tolerance are left, and none of those tried gained anything: as far as the model's noise
    /// lets one see.
    Step,
    /// The budget of evaluations is spent; a better point may be near.
    Budget,
}

impl Stop {
    /// Every reason.
    pub const ALL: [Self; 3] = [Self::Decrease, Self::Step, Self::Budget];

    /// The reason as a word: `decrease`, `step`, `budget`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Decrease => "decrease",
            Self::Step => "step",
            Self::Budget => "budget",
        }
    }

    /// The reason of a word.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stop| stop.name() == name)
    }
}

/// The most probable parameters and what the parabola around them says of their uncertainty.
///
/// The parabola is Laplace's approximation (Tierney & Kadane 1986, J. Am. Stat. Assoc. 81:82): right for a normal
/// posterior, checked there by `lm::a_linear_model_with_normal_priors_has_its_closed_form`.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// The parameters, in the order of the prior.
    pub theta: Vec<f64>,
    /// ln p(data | theta), in nats.
    pub log_likelihood: f64,
    /// ln p(theta), the density of the parameters as declared, in nats.
    pub log_prior: f64,
    /// Whether each parameter lies exactly at a bound of its prior.
    pub at_bound: Vec<bool>,
    /// Standard deviation of each parameter after Laplace, the others free; `None` at a bound and where nothing fixes it.
    pub sd: Vec<Option<f64>>,
    /// Covariance after Laplace, in the units of the parameters: the inverse of the curvature of f, the model's own curvature
    /// left out. Rows and columns of parameters without a standard deviation are 0.
    pub covariance: Vec<Vec<f64>>,
    /// Evaluations spent.
    pub evaluations: u64,
    /// Those that the model rejected.
    pub rejected: u64,
    /// Why the fit ended.
    pub stop: Stop,
}

impl Estimate {
    /// ln p(data | theta) + ln p(theta), in nats; without the evidence, which a fit does not know.
    #[must_use]
    pub fn log_posterior(&self) -> f64 {
        self.log_likelihood + self.log_prior
    }

    /// The estimate at a point; evaluations are counted by the caller.
    pub(super) fn at(objective: &Objective, point: &Point, columns: &[Column], stop: Stop) -> Self {
        let dimension = objective.prior.dimension();
        let mut at_bound = vec![false; dimension];
        let mut covariance = vec![vec![0.0; dimension]; dimension];
        let mut sd = vec![None; dimension];
        for (axis, &t) in objective.axes.iter().zip(&point.position) {
            at_bound[axis.parameter] = axis.is_bound(t);
        }
        for (noise, profiled) in objective.noises.iter().zip(&point.noise) {
            let k = noise.parameter;
            at_bound[k] = profiled.at_bound;
            sd[k] = profiled.uncertainty;
            covariance[k][k] = profiled.uncertainty.map_or(0.0, |sd| sd * sd);
        }
        let hessian = objective.quadratic(point, columns).hessian;
        let free: Vec<usize> = (0..objective.axes.len())
            .filter(|&k| {
                let known = columns.get(k).is_some_and(Option::is_some);
                known && !at_bound[objective.axes[k].parameter] && hessian[(k, k)] > 0.0
            })
            .collect();
        let curvature = DMatrix::from_fn(free.len(), free.len(), |i, j| hessian[(free[i], free[j])]);
        if let Some(cholesky) = Cholesky::new(curvature) {
            let inverse = cholesky.inverse();
            let rate = |i: usize| objective.axes[free[i]].rate(point.position[free[i]]);
            let parameter = |i: usize| objective.axes[free[i]].parameter;
            for i in 0..free.len() {
                for j in 0..free.len() {
                    covariance[parameter(i)][parameter(j)] = rate(i) * inverse[(i, j)] * rate(j);
                }
                sd[parameter(i)] = Some(rate(i) * inverse[(i, i)].sqrt());
            }
        }
        Self {
            theta: point.theta.clone(),
            log_likelihood: point.log_likelihood,
            log_prior: point.log_prior,
            at_bound,
            sd,
            covariance,
            evaluations: 0,
            rejected: 0,
            stop,
        }
    }
}
