//! The evidence of a fitted model under another error model.
//!
//! Predictions are linear in the parameters about the fit, so that no model is run: the parameters, inferred noise sds among them,
//! are fitted again.

use nalgebra::{Cholesky, DVector};

use crate::laplace::evidence::log_volume;
use crate::laplace::fit::LaplaceFit;
use crate::laplace::point::FitPoint;
use crate::laplace::quadratic::quadratic;
use inference::lm::QuadraticModel;
use statistics::likelihood::Likelihood;

/// Maximum number of steps of a fit, and of consecutive steps without a gain.
const MAX_STEPS: usize = 20;
const MAX_FAILURES: usize = 5;
/// Predicted gain below which a fit ends `[nats]`.
const MIN_GAIN: f64 = 1e-3;
/// The damping after the first rejected step, and the factor between successive dampings.
const FIRST_DAMPING: f64 = 0.05;
const DAMPING_FACTOR: f64 = 8.0;

/// A model that is linear about a fit, under another likelihood of the same data.
pub(crate) struct LinearisedModel<'a> {
    pub(crate) fit: &'a LaplaceFit,
    pub(crate) likelihood: &'a Likelihood,
    /// Derivatives that the likelihood takes beyond those of the fit; they are constant.
    pub(crate) further_values: &'a [f64],
}

impl LinearisedModel<'_> {
    /// Returns the mode nearest to a start; `None` where the likelihood is zero at the start.
    pub(crate) fn mode(&self, start: Vec<f64>) -> Option<FitPoint> {
        let mut point = self.point(start)?;
        let (mut damping, mut failures) = (0.0, 0);
        for _ in 0..MAX_STEPS {
            let quadratic = self.quadratic(&point);
            let Some(step) = quadratic.step(damping) else {
                break;
            };
            if quadratic.decrease(&step) < MIN_GAIN || failures > MAX_FAILURES {
                break;
            }
            let position = point.position.iter().zip(&step).map(|(t, by)| t + by).collect();
            match self.point(position).filter(|next| next.value < point.value) {
                Some(next) => {
                    (point, failures) = (next, 0);
                    damping /= DAMPING_FACTOR;
                }
                None => {
                    failures += 1;
                    damping = FIRST_DAMPING.max(damping * DAMPING_FACTOR);
                }
            }
        }
        Some(point)
    }

    /// Returns the log evidence by Laplace's approximation at a mode; `None` where the Hessian is not positive definite.
    pub(crate) fn log_evidence(&self, mode: &FitPoint) -> Option<f64> {
        Some(log_volume(&self.quadratic(mode))? - mode.value)
    }

    /// Returns mean and sd, at a mode, of a factor on each direction along which errors may shift the data; its prior is standard normal.
    /// `None` where the Hessian is not positive definite.
    ///
    /// # Equation
    /// With `S` the covariance of the data, v the direction among its errors, r the residuals, J the derivatives by the parameters and
    /// H the Hessian: mean `v' S^-1 r`, variance `1 - v' S^-1 v + v' S^-1 J H^-1 J' S^-1 v`.
    pub(crate) fn factors(
        &self,
        mode: &FitPoint,
        directions: impl Iterator<Item = Vec<f64>>,
    ) -> Option<Vec<[f64; 2]>> {
        let theta = self.fit.frame.theta(&mode.position);
        let whitening = self.likelihood.whitening(&mode.values, &theta).ok()?;
        let columns: Vec<Vec<f64>> = self.fit.columns.iter().map(|c| whitening.apply(c)).collect();
        let cholesky = Cholesky::new(self.quadratic(mode).hessian)?;
        let factor = |direction: Vec<f64>| {
            let along = whitening.apply(&direction);
            let shared = columns.iter().map(|column| whitening.curvature(&along, column));
            let shared = DVector::from_vec(shared.collect());
            let by_parameters = cholesky.solve(&shared).dot(&shared);
            let variance = 1.0 - whitening.curvature(&along, &along) + by_parameters;
            [whitening.slope(&along), variance.max(0.0).sqrt()]
        };
        Some(directions.map(factor).collect())
    }

    fn point(&self, position: Vec<f64>) -> Option<FitPoint> {
        let mut values = self.fit.point.values.clone();
        for (k, column) in self.fit.columns.iter().enumerate() {
            let by = position[k] - self.fit.point.position[k];
            for (value, derivative) in values.iter_mut().zip(column) {
                *value += by * derivative;
            }
        }
        values.extend(self.further_values);
        FitPoint::new(&self.fit.frame, self.likelihood, position, values)
    }

    fn quadratic(&self, point: &FitPoint) -> QuadraticModel {
        quadratic(&self.fit.frame, self.likelihood, point, &self.fit.columns)
    }
}
