//! The normal approximation of the posterior about the result of a fit, and draws from it.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::objective::{Column, FitPoint, Objective};
use crate::point_estimate::NormalApproximation;
use crate::tmcmc::Particle;
use statistics::LogLikelihood;
use statistics::prior::LN_SQRT_TAU;
use statistics::rng::Stream;

/// Random streams of the draws; those of the starts have stage 0.
const DRAWS: u64 = 1 << 42;
/// A parameter at a bound begins at this score: the score of the bound itself is infinite.
const FARTHEST_START: f64 = 3.0;
/// Maximum number of steps to the mode of the scores.
const STEPS: u32 = 50;
/// Maximum number of halvings of a step.
const HALVINGS: u32 = 30;
/// Gain of a step below which the mode is reached \[nats\].
const NO_GAIN: f64 = 1e-9;
/// Half the width of differences along the score of an sd.
const DIFFERENCE: f64 = 1e-3;

/// The posterior of the model linearised at a point, over the normal scores of all parameters.
struct LinearisedPosterior<'a> {
    objective: &'a Objective,
    point: &'a FitPoint,
    columns: &'a [Column],
}

impl Objective {
    /// Draws from the normal density of the normal scores z about their mode.
    ///
    /// ```text
    /// ln q(z) = ln p(data | m + J (t(z) - t), sds(z)) + ln p(z),   H = -q''(z*),   z ~ N(z*, H^-1)
    /// ln Z   ~= ln q(z*) + d/2 ln(2 pi) - 1/2 ln det H
    /// ```
    ///
    /// with m and J the model's values and their Jacobian at the fit, and t the coordinates of the fit. `H` is the sum of the
    /// curvature of the prior, the Gauss-Newton curvature of the likelihood along the model's parameters, and its exact curvature
    /// along each sd. Scores keep every draw within the bounds of its prior; the draws of a parameter at a bound have one tail of
    /// a normal density.
    ///
    /// Returns `None` if q has no finite mode. Draws whose log-likelihood is minus infinity are left out.
    ///
    /// Checked by `lm::draws_of_a_linear_model_have_its_closed_form_and_evidence`,
    /// `lm::draws_stay_within_bounds_where_the_mode_is_at_one`.
    pub(super) fn approximation(
        &self,
        point: &FitPoint,
        columns: &[Column],
        (draws, seed): (usize, u64),
    ) -> Option<NormalApproximation> {
        let posterior = LinearisedPosterior {
            objective: self,
            point,
            columns,
        };
        let (mode, log_density, precision) = posterior.mode()?;
        let dimension = mode.len();
        let half_log_determinant: f64 = precision.l().diagonal().iter().map(|d| libm::log(*d)).sum();
        let factor = Cholesky::new(precision.inverse())?.l();
        let draw = |k: usize| {
            let normals = Stream::new(seed, DRAWS, k as u64, 0).normals(dimension);
            let scores = &mode + &factor * DVector::from_vec(normals);
            let theta = posterior.theta(scores.as_slice());
            Particle {
                log_likelihood: posterior.log_likelihood(&theta),
                log_prior: self.prior.log_density(&theta),
                theta,
            }
        };
        let draws = (0..draws).map(draw);
        Some(NormalApproximation {
            log_evidence: log_density + dimension as f64 * LN_SQRT_TAU - half_log_determinant,
            draws: draws.filter(|d| !d.log_likelihood.is_impossible()).collect(),
        })
    }
}

impl LinearisedPosterior<'_> {
    fn theta(&self, scores: &[f64]) -> Vec<f64> {
        let marginals = self.objective.prior.marginals().iter();
        marginals
            .zip(scores)
            .map(|(m, &z)| m.from_normal_score(z))
            .collect()
    }

    /// Returns the values of the linearised model.
    fn predicted(&self, theta: &[f64]) -> Vec<f64> {
        let mut predicted = self.point.predicted.clone();
        let axes = self.objective.axes.iter().zip(&self.point.position);
        for ((axis, from), column) in axes.zip(self.columns) {
            let by = axis.position(theta[axis.parameter]) - from;
            for (value, change) in predicted.iter_mut().zip(column.iter().flatten()) {
                *value += by * change;
            }
        }
        predicted
    }

    fn log_likelihood(&self, theta: &[f64]) -> LogLikelihood {
        let scored = self
            .objective
            .likelihood
            .log_likelihood(&self.predicted(theta), theta);
        // An sd of zero can be drawn from a prior that reaches zero; it has no likelihood.
        scored.unwrap_or(LogLikelihood::Impossible)
    }

    /// Returns ln q of scores.
    fn log_density(&self, scores: &[f64]) -> f64 {
        let theta = self.theta(scores);
        let prior = &self.objective.prior;
        let marginals = prior.marginals().iter().zip(&theta);
        let marginals_density: f64 = marginals.map(|(marginal, &x)| marginal.log_density(x)).sum();
        let scores_density: f64 = scores.iter().map(|z| -0.5 * z * z - LN_SQRT_TAU).sum();
        let correlation_density = prior.log_density(&theta) - marginals_density;
        self.log_likelihood(&theta).value() + scores_density + correlation_density
    }

    /// Returns the mode of q, ln q there, and its precision; by Newton steps that are halved until they gain.
    fn mode(&self) -> Option<(DVector<f64>, f64, Cholesky<f64, Dyn>)> {
        let marginals = self.objective.prior.marginals().iter().zip(&self.point.theta);
        let start = marginals.map(|(marginal, &x)| marginal.normal_score(x));
        let start = start.map(|z| z.clamp(-FARTHEST_START, FARTHEST_START));
        let mut scores = DVector::from_iterator(self.point.theta.len(), start);
        let mut value = Some(self.log_density(scores.as_slice())).filter(|v| v.is_finite())?;
        for _ in 0..STEPS {
            let (gradient, hessian) = self.parabola(&scores)?;
            let step = Cholesky::new(hessian)?.solve(&gradient);
            let tried = (0..HALVINGS).map(|k| &scores + &step / f64::from(1_u32 << k));
            let mut gains = tried.map(|moved| (self.log_density(moved.as_slice()), moved));
            let Some((higher, moved)) = gains.find(|(density, _)| *density > value) else {
                break;
            };
            let gain = higher - value;
            (value, scores) = (higher, moved);
            if gain < NO_GAIN {
                break;
            }
        }
        let (_, hessian) = self.parabola(&scores)?;
        Some((scores, value, Cholesky::new(hessian)?))
    }

    /// Returns the gradient of ln q and curvature of -ln q at scores; `None` where the data have probability zero.
    fn parabola(&self, scores: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let Objective {
            prior,
            likelihood,
            axes,
            ..
        } = self.objective;
        let theta = self.theta(scores.as_slice());
        let predicted = self.predicted(&theta);
        let mut gradient = -scores;
        let mut hessian = DMatrix::identity(scores.len(), scores.len());
        let whitening = likelihood.whitening(&predicted, &theta).ok()?;
        // dt/dz of every axis whose column is known, and its whitened column times that.
        let whitened: Vec<(usize, Vec<f64>)> = axes
            .iter()
            .zip(self.columns)
            .filter_map(|(axis, column)| {
                let (k, column) = (axis.parameter, column.as_ref()?);
                let log_density = prior.marginals()[k].log_density(theta[k]);
                let score_density = libm::exp(-0.5 * scores[k] * scores[k] - LN_SQRT_TAU - log_density);
                let rate = score_density / axis.rate(axis.position(theta[k]));
                let moved: Vec<f64> = column.iter().map(|change| rate * change).collect();
                Some((k, whitening.apply(&moved)))
            })
            .collect();
        for (k, column) in &whitened {
            gradient[*k] += whitening.slope(column);
            for (l, row) in &whitened {
                hessian[(*k, *l)] += whitening.curvature(column, row);
            }
        }
        for k in self.objective.noises.parameters() {
            let at = |offset: f64| {
                let mut theta = theta.clone();
                theta[k] = prior.marginals()[k].from_normal_score(scores[k] + offset);
                let scored = likelihood.log_likelihood(&predicted, &theta);
                scored.map_or(f64::NEG_INFINITY, |l| l.value())
            };
            let (below, middle, above) = (at(-DIFFERENCE), at(0.0), at(DIFFERENCE));
            let slope = (above - below) / (2.0 * DIFFERENCE);
            let bend = (2.0 * middle - below - above) / (DIFFERENCE * DIFFERENCE);
            if slope.is_finite() && bend.is_finite() {
                gradient[k] += slope;
                // The likelihood is flat towards an sd of 0: the curvature of the prior remains.
                hessian[(k, k)] += bend.max(0.0);
            }
        }
        let correlation = prior.slopes_of_correlation(&theta);
        for (k, slope) in correlation.slopes {
            gradient[k] -= slope;
        }
        for (k, l, curvature) in correlation.curvatures {
            hessian[(k, l)] += curvature;
        }
        Some((gradient, hessian))
    }
}
