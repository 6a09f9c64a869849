//! The objective of a fit: the negative log-posterior at a point, and its quadratic approximation there.

use nalgebra::DMatrix;

use super::noise::Profiled;
use super::noise_profile::NoiseProfile;
use super::quadratic_model::QuadraticModel;
use crate::point_estimate::PriorAxis;
use statistics::likelihood::Likelihood;
use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;

/// A column of the Jacobian: the change of every predicted value along one axis; `None` where it is not known.
pub(super) type Column = Option<Vec<f64>>;

/// The objective function.
#[derive(Debug, Clone)]
pub(super) struct Objective {
    pub(super) prior: Prior,
    pub(super) likelihood: Likelihood,
    pub(super) axes: Vec<PriorAxis>,
    /// The inferred sds of noise and common errors.
    pub(super) noises: NoiseProfile,
}

/// An evaluated point with the most probable noise sds there.
#[derive(Debug, Clone)]
pub(super) struct FitPoint {
    pub(super) position: Vec<f64>,
    pub(super) theta: Vec<f64>,
    pub(super) predicted: Vec<f64>,
    /// Value of the objective f, in nats.
    pub(super) value: f64,
    pub(super) log_likelihood: f64,
    pub(super) log_prior: f64,
    /// A noise sd for each entry of [`Objective::noises`].
    pub(super) noise: Vec<Profiled>,
}

impl Objective {
    pub(super) fn new(prior: Prior, likelihood: Likelihood) -> Self {
        let noises = NoiseProfile::new(&prior, &likelihood);
        let sds = noises.parameters();
        let axes = prior
            .marginals()
            .iter()
            .enumerate()
            .filter(|(parameter, _)| !sds.contains(parameter))
            .map(|(parameter, marginal)| PriorAxis::new(parameter, marginal))
            .collect();
        Self {
            prior,
            likelihood,
            axes,
            noises,
        }
    }

    /// Returns the point of a parameter vector, whose noise sds are ignored; `None` where f is infinite.
    pub(super) fn point(&self, theta: &[f64], predicted: &[f64]) -> Option<FitPoint> {
        let noise = self
            .noises
            .profile(&self.prior, &self.likelihood, theta, predicted);
        let mut theta = theta.to_vec();
        for (parameter, profiled) in self.noises.parameters().into_iter().zip(&noise) {
            theta[parameter] = profiled.sd;
        }
        let log_prior = self.prior.log_density(&theta);
        let Ok(LogLikelihood::Finite(log_likelihood)) = self.likelihood.log_likelihood(predicted, &theta)
        else {
            return None;
        };
        let value = -(log_likelihood.get() + log_prior + self.noises.change_of_measure(&self.prior, &theta));
        value.is_finite().then(|| FitPoint {
            position: self
                .axes
                .iter()
                .map(|axis| axis.position(theta[axis.parameter]))
                .collect(),
            theta,
            predicted: predicted.to_vec(),
            value,
            log_likelihood: log_likelihood.get(),
            log_prior,
            noise,
        })
    }

    /// Returns the parameter vector at a position, with the noise sds of a point.
    pub(super) fn theta(&self, point: &FitPoint, position: &[f64]) -> Vec<f64> {
        let mut theta = point.theta.clone();
        for (axis, &t) in self.axes.iter().zip(position) {
            theta[axis.parameter] = axis.value(t);
        }
        theta
    }

    /// Returns the parabola of f along the axes around a point: slopes `-sum_i J_ik r_i / sd_i^2 + (-ln p_k)'`, curvatures `sum_i
    /// J_ik J_il / sd_i^2 + (-ln p_k)''`; of correlated or heavy-tailed data with
    /// [`Whitening`](statistics::likelihood::Whitening) in place of the sds.
    ///
    /// This is the Gauss-Newton approximation: it leaves out the model's curvature and that of the noise sds, whose mixed curvature
    /// with the axes has expectation zero. Axes without a column do not move.
    pub(super) fn quadratic(&self, point: &FitPoint, columns: &[Column]) -> QuadraticModel {
        // A point has a finite f, so it can be whitened.
        let whitening = self.likelihood.whitening(&point.predicted, &point.theta).ok();
        let scaled: Vec<Option<Vec<f64>>> = columns
            .iter()
            .map(|column| Some(whitening.as_ref()?.apply(column.as_ref()?)))
            .collect();
        let count = self.axes.len();
        let mut gradient = vec![0.0; count];
        let mut hessian = DMatrix::zeros(count, count);
        for (k, axis) in self.axes.iter().enumerate() {
            let (slope, curvature) = axis.slope(point.position[k]);
            gradient[k] = slope;
            hessian[(k, k)] = curvature;
            let (Some(column), Some(whitening)) = (&scaled[k], &whitening) else {
                continue;
            };
            gradient[k] -= whitening.slope(column);
            for (l, row) in scaled.iter().enumerate() {
                if let Some(row) = row {
                    hessian[(k, l)] += whitening.curvature(column, row);
                }
            }
        }
        // Correlations relate normal marginals in units of their sds, and the axis of a normal marginal has this unit.
        let correlation = self.prior.slopes_of_correlation(&point.theta);
        let axis_of = |parameter: usize| self.axes.iter().position(|axis| axis.parameter == parameter);
        for (parameter, slope) in correlation.slopes {
            if let Some(k) = axis_of(parameter) {
                gradient[k] += slope;
            }
        }
        for (parameter, second, curvature) in correlation.curvatures {
            if let (Some(k), Some(l)) = (axis_of(parameter), axis_of(second)) {
                hessian[(k, l)] += curvature;
            }
        }
        QuadraticModel {
            gradient,
            hessian,
            lower: self.room(point, |axis| axis.lower),
            upper: self.room(point, |axis| axis.upper),
            held: columns.iter().map(Option::is_none).collect(),
        }
    }

    fn room(&self, point: &FitPoint, bound: impl Fn(&PriorAxis) -> f64) -> Vec<f64> {
        self.axes
            .iter()
            .zip(&point.position)
            .map(|(axis, t)| bound(axis) - t)
            .collect()
    }

    /// Returns the position after a step; exactly at a bound if the step ends there.
    pub(super) fn moved(&self, point: &FitPoint, step: &[f64]) -> Vec<f64> {
        self.axes
            .iter()
            .zip(point.position.iter().zip(step))
            .map(|(axis, (t, move_by))| {
                if *move_by <= axis.lower - t {
                    axis.lower
                } else if *move_by >= axis.upper - t {
                    axis.upper
                } else {
                    t + move_by
                }
            })
            .collect()
    }
}
