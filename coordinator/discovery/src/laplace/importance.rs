//! An importance sampler of the evidence, for models of which Laplace's approximation may be too inaccurate.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::LaplaceFit;
use crate::laplace::point::FitPoint;
use crate::laplace::strength_prior::{self, stated_over_mixed};
use crate::laplace::student::Student;
use statistics::likelihood::Likelihood;
use statistics::prior::LN_SQRT_TAU;
use statistics::rng::Stream;

/// Draws per round, and the maximum number of rounds.
const DRAWS: usize = 150;
const ROUNDS: usize = 8;
/// Effective sample size at which the sampling ends (a standard error of 0.13 nats), and the smallest that gives an estimate.
const ENOUGH: f64 = 60.0;
const MIN_SIZE: f64 = 30.0;
/// Scale of the strength about its absence, in standard deviations of its prior.
const WEAK: f64 = 0.5;
/// Random streams of the draws, separate from those of any sampler.
const STAGE: u64 = 1 << 42;

/// Adaptive importance sampling of the evidence of one model. Draws come from a Student t distribution about the fit, adapted after
/// each round. If the effect may be absent, a second t distribution is centred on its absence, where the data do not constrain its
/// shape.
///
/// All rounds count. A draw is weighted by prior times likelihood over the mean density of all t's, so that a draw in a tail that
/// the adapted t misses keeps a bounded weight.
///
/// # Source
/// Cornuet et al. 2012, doi:10.1111/j.1467-9469.2011.00756.x.
#[derive(Debug, Clone)]
pub(crate) struct ImportanceSampler {
    frame: NormalFrame,
    /// The t of each round so far, and of the next rounds that are already decided.
    proposals: Vec<Student>,
    round: usize,
    /// Draws of the current round within the limits.
    pending: Vec<Vec<f64>>,
    /// Draws of all rounds with their log prior times likelihood.
    drawn: Vec<(Vec<f64>, f64)>,
    log_evidence: Option<f64>,
    /// Log evidence with the stated priors of the strengths, less `log_evidence`.
    stated_gain: f64,
    is_done: bool,
}

impl ImportanceSampler {
    /// Begins about a fit; `None` where its Hessian is not positive definite.
    pub(crate) fn new(fitted: &LaplaceFit, likelihood: &Likelihood) -> Option<Self> {
        // Near absence the mixture's prior is narrower than the tail of the posterior.
        let quadratic = fitted.quadratic(likelihood);
        let stated = strength_prior::stated(&fitted.frame, &fitted.point.position, &quadratic);
        let covariance = Cholesky::new(stated.hessian)?.inverse();
        let mean = DVector::from_column_slice(&fitted.point.position);
        Some(Self {
            frame: fitted.frame.clone(),
            proposals: vec![Student::new(mean, covariance)?],
            round: 0,
            pending: Vec::new(),
            drawn: Vec::new(),
            log_evidence: None,
            stated_gain: 0.0,
            is_done: false,
        })
    }

    /// Adds a second t about the base's fit, where the effect is absent and its shape has its prior.
    pub(crate) fn or_absent(mut self, base: &LaplaceFit, likelihood: &Likelihood) -> Self {
        let mut position = base.point.position.clone();
        position.resize(self.frame.dimension(), 0.0);
        let mean = DVector::from_vec(self.frame.without(&position));
        let covariance = Cholesky::new(base.quadratic(likelihood).hessian).map(|c| c.inverse());
        let base_dimension = base.frame.dimension();
        let scale = covariance.map(|covariance| {
            DMatrix::from_fn(mean.len(), mean.len(), |k, l| {
                match (k.max(l) < base_dimension, k == l) {
                    (true, _) => covariance[(k, l)],
                    (false, true) if self.frame.is_strength(k) => WEAK * WEAK,
                    (false, true) => 1.0,
                    (false, false) => 0.0,
                }
            })
        });
        let absent = scale.and_then(|scale| Student::new(mean, scale));
        self.proposals.extend(absent);
        self
    }

    /// Returns the positions to evaluate next; none once the sampling has ended.
    pub(crate) fn ask(&mut self, seed: u64, number: u64) -> Vec<Vec<f64>> {
        let Some(proposal) = self.proposals.get(self.round).filter(|_| !self.is_done) else {
            return Vec::new();
        };
        let mut stream = Stream::new(seed, STAGE, number, self.round as u64);
        let draws = (0..DRAWS).map(|_| proposal.draw(&mut stream));
        self.pending = draws.filter(|position| self.frame.holds(position)).collect();
        self.pending.clone()
    }

    /// Takes the predicted values at the positions of [`ask`](Self::ask); `None` where the model rejected one. Draws without
    /// likelihood count as zero.
    pub(crate) fn tell(&mut self, likelihood: &Likelihood, answers: Vec<Option<Vec<f64>>>) {
        let dimension = self.frame.dimension() as f64;
        // The prior of a half-normal coordinate is twice the normal one.
        let constant = libm::log(2.0) * self.frame.halves().len() as f64 - dimension * LN_SQRT_TAU;
        for (position, values) in std::mem::take(&mut self.pending).into_iter().zip(answers) {
            let point = values.and_then(|v| FitPoint::new(&self.frame, likelihood, position, v));
            self.drawn
                .extend(point.map(|point| (point.position, constant - point.value)));
        }
        self.round += 1;
        if self.round < self.proposals.len() {
            return;
        }
        let log_draws = libm::log(DRAWS as f64);
        let log_weight = |(position, log_posterior): &(Vec<f64>, f64)| {
            let densities = self.proposals.iter().map(|t| t.log_density(position));
            log_posterior - log_sum_exp(densities) - log_draws
        };
        let log_weights: Vec<f64> = self.drawn.iter().map(log_weight).collect();
        let shares = shares(&log_weights, 1.0);
        let effective = effective(&shares);
        self.log_evidence = (effective >= MIN_SIZE).then(|| log_sum_exp(log_weights.iter().copied()));
        let stated = self.drawn.iter().zip(&shares);
        let stated =
            stated.map(|((position, _), share)| share * libm::exp(stated_over_mixed(&self.frame, position)));
        self.stated_gain = libm::log(stated.sum());
        let adapted = (effective < ENOUGH && self.proposals.len() < ROUNDS)
            .then(|| self.adapted(&tempered(&log_weights)))
            .flatten();
        self.is_done = adapted.is_none();
        self.proposals.extend(adapted);
    }

    /// Returns the t with mean and scale of the weighted draws; `None` where their covariance is singular.
    fn adapted(&self, shares: &[f64]) -> Option<Student> {
        let old_scale = self.proposals.last()?.scale();
        let dimension = self.frame.dimension();
        let pairs = || self.drawn.iter().map(|(position, _)| position).zip(shares);
        let mean = DVector::from_fn(dimension, |k, _| pairs().map(|(t, share)| share * t[k]).sum());
        let scale = DMatrix::from_fn(dimension, dimension, |k, l| {
            let seen: f64 = pairs()
                .map(|(t, share)| share * (t[k] - mean[k]) * (t[l] - mean[l]))
                .sum();
            // Averaged with the old scale, so that a few draws of large weight do not collapse it.
            0.5 * (seen + old_scale[(k, l)])
        });
        Student::new(mean, scale)
    }

    /// Returns the log evidence; `None` where the effective sample size is too small.
    pub(crate) fn log_evidence(&self) -> Option<f64> {
        self.log_evidence
    }

    /// Returns the log evidence with the stated priors of the strengths less [`log_evidence`](Self::log_evidence).
    pub(crate) fn stated_gain(&self) -> f64 {
        self.stated_gain
    }
}

/// Returns the share of each draw in the sum of the weights raised to a power.
fn shares(log_weights: &[f64], power: f64) -> Vec<f64> {
    let log_sum = log_sum_exp(log_weights.iter().map(|w| power * w));
    log_weights
        .iter()
        .map(|w| libm::exp(power * w - log_sum))
        .collect()
}

/// Returns the effective sample size of the shares; 0 without draws.
fn effective(shares: &[f64]) -> f64 {
    if shares.is_empty() {
        return 0.0;
    }
    1.0 / shares.iter().map(|s| s * s).sum::<f64>()
}

/// Returns the shares at the highest power of the weights, up to 1, whose effective sample size suffices for an estimate: a t
/// adapted to fewer draws would collapse.
fn tempered(log_weights: &[f64]) -> Vec<f64> {
    let all = shares(log_weights, 1.0);
    if effective(&all) >= MIN_SIZE {
        return all;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if effective(&shares(log_weights, middle)) >= MIN_SIZE {
            low = middle;
        } else {
            high = middle;
        }
    }
    shares(log_weights, low)
}
