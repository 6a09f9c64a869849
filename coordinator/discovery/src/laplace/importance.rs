//! The evidence by importance sampling, where Laplace's approximation may be too inaccurate.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::LaplaceFit;
use crate::laplace::point::FitPoint;
use statistics::likelihood::Likelihood;
use statistics::prior::LN_SQRT_TAU;
use statistics::rng::Stream;

/// Draws per round, and the most rounds.
const DRAWS: usize = 150;
const ROUNDS: u64 = 2;
/// Effective sample size at which the sampling ends (a standard error of 0.13 nats), and the least for an estimate.
const ENOUGH: f64 = 60.0;
const LEAST: f64 = 30.0;
/// Degrees of freedom of the proposal: its tails are heavier than those of a normal posterior.
const FREEDOM: usize = 6;
/// Random streams of the draws, separate from those of any sampler.
const STAGE: u64 = 1 << 42;

/// The evidence of one model by draws from a multivariate t about its fit, adapted after each round.
#[derive(Debug, Clone)]
pub(crate) struct ImportanceSampler {
    frame: NormalFrame,
    mean: DVector<f64>,
    /// Lower factor of the t's scale matrix.
    factor: DMatrix<f64>,
    round: u64,
    /// Draws of the round within the limits, with their log densities under the t.
    drawn: Vec<(Vec<f64>, f64)>,
    log_evidence: Option<f64>,
}

impl ImportanceSampler {
    /// About a fit; `None` where its Hessian is not positive definite.
    pub(crate) fn new(fitted: &LaplaceFit, likelihood: &Likelihood) -> Option<Self> {
        let covariance = Cholesky::new(fitted.quadratic(likelihood).hessian)?.inverse();
        Some(Self {
            frame: fitted.frame.clone(),
            mean: DVector::from_column_slice(&fitted.point.position),
            factor: Cholesky::new(covariance)?.l(),
            round: 0,
            drawn: Vec::new(),
            log_evidence: None,
        })
    }

    /// The positions to evaluate next; none once the sampling has ended.
    pub(crate) fn ask(&mut self, seed: u64, number: u64) -> Vec<Vec<f64>> {
        if self.round == ROUNDS {
            return Vec::new();
        }
        let mut stream = Stream::new(seed, STAGE, number, self.round);
        let dimension = self.mean.len();
        let (d, nu) = (dimension as f64, FREEDOM as f64);
        let log_determinant: f64 = (0..dimension).map(|k| libm::log(self.factor[(k, k)])).sum();
        let constant = libm::lgamma(0.5 * (nu + d))
            - libm::lgamma(0.5 * nu)
            - 0.5 * d * libm::log(nu * std::f64::consts::PI)
            - log_determinant;
        self.drawn.clear();
        for _ in 0..DRAWS {
            let normals = stream.normals(dimension + FREEDOM);
            let (z, rest) = normals.split_at(dimension);
            let stretch = nu / rest.iter().map(|x| x * x).sum::<f64>();
            let z = DVector::from_column_slice(z) * stretch.sqrt();
            let log_density = constant - 0.5 * (nu + d) * libm::log1p(z.norm_squared() / nu);
            let position: Vec<f64> = (&self.mean + &self.factor * z).iter().copied().collect();
            if self.frame.holds(&position) {
                self.drawn.push((position, log_density));
            }
        }
        self.drawn.iter().map(|(position, _)| position.clone()).collect()
    }

    /// Takes the predicted values at those positions; `None` where the model rejected one.
    ///
    /// The evidence is the mean of prior times likelihood over the density of the t; draws outside the support count as zero.
    pub(crate) fn tell(&mut self, likelihood: &Likelihood, answers: Vec<Option<Vec<f64>>>) {
        self.round += 1;
        // The prior of a half-normal coordinate is twice the normal one.
        let halves = libm::log(2.0) * self.frame.halves().len() as f64;
        let constant = halves - self.mean.len() as f64 * LN_SQRT_TAU - libm::log(DRAWS as f64);
        let drawn = std::mem::take(&mut self.drawn);
        let weighted: Vec<(Vec<f64>, f64)> = drawn
            .into_iter()
            .zip(answers)
            .filter_map(|((position, log_density), values)| {
                let point = FitPoint::new(&self.frame, likelihood, position, values?)?;
                let log_weight = constant - point.value - log_density;
                Some((point.position, log_weight))
            })
            .collect();
        let log_sum = log_sum_exp(weighted.iter().map(|(_, w)| *w));
        let shares: Vec<f64> = weighted.iter().map(|(_, w)| libm::exp(w - log_sum)).collect();
        let effective = 1.0 / shares.iter().map(|s| s * s).sum::<f64>();
        self.log_evidence = (effective >= LEAST).then_some(log_sum);
        if effective >= ENOUGH {
            self.round = ROUNDS;
        } else {
            self.adapt(&weighted, &shares);
        }
    }

    /// Moves the t to the weighted draws, unless their covariance is singular.
    fn adapt(&mut self, weighted: &[(Vec<f64>, f64)], shares: &[f64]) {
        let dimension = self.mean.len();
        let pairs = || weighted.iter().map(|(position, _)| position).zip(shares);
        let mean = DVector::from_fn(dimension, |k, _| pairs().map(|(t, share)| share * t[k]).sum());
        let own = &self.factor * self.factor.transpose();
        let covariance = DMatrix::from_fn(dimension, dimension, |k, l| {
            let seen: f64 = pairs()
                .map(|(t, share)| share * (t[k] - mean[k]) * (t[l] - mean[l]))
                .sum();
            // Averaged with the old scale, so that a few draws of large weight do not collapse it.
            0.5 * (seen + own[(k, l)])
        });
        if let Some(cholesky) = Cholesky::new(covariance) {
            self.mean = mean;
            self.factor = cholesky.l();
        }
    }

    /// Log evidence; `None` where the effective sample size is too small.
    pub(crate) fn log_evidence(&self) -> Option<f64> {
        self.log_evidence
    }
}
