//! Gradient and curvature along inferred noise sds, on which the predicted values do not depend.

use nalgebra::DMatrix;

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::point::FitPoint;
use statistics::likelihood::{ErrorSd, Likelihood};

/// Half width of the central differences; the density is smooth and accurate to rounding.
const DIFFERENCE: f64 = 1e-3;

/// The coordinates that are noise sds, each with the number of data that share it.
pub(crate) fn coordinates(likelihood: &Likelihood) -> Vec<(usize, usize)> {
    let inferred = |sd: ErrorSd| match sd {
        ErrorSd::Inferred { parameter } => Some(parameter),
        ErrorSd::Known(_) => None,
    };
    let mut parameters: Vec<usize> = likelihood.data().iter().filter_map(|d| inferred(d.sd)).collect();
    parameters.sort_unstable();
    let groups = parameters.chunk_by(|a, b| a == b);
    groups.map(|group| (group[0], group.len())).collect()
}

/// Adds the gradient of `-log-likelihood` along the noise sds, and the expected curvature `2 N (d ln sd / dt)^2` of N data.
pub(crate) fn add(
    frame: &NormalFrame,
    likelihood: &Likelihood,
    point: &FitPoint,
    gradient: &mut [f64],
    hessian: &mut DMatrix<f64>,
) {
    for (k, count) in coordinates(likelihood) {
        let at = |offset: f64| {
            let mut position = point.position.clone();
            position[k] += offset;
            let theta = frame.theta(&position);
            let scored = likelihood.log_likelihood(&point.values, &theta);
            (theta[k], scored.map_or(f64::NEG_INFINITY, |s| s.value()))
        };
        let ((low, before), (high, after)) = (at(-DIFFERENCE), at(DIFFERENCE));
        let slope = (after - before) / (2.0 * DIFFERENCE);
        let stretch = libm::log(high / low) / (2.0 * DIFFERENCE);
        if slope.is_finite() && stretch.is_finite() {
            gradient[k] -= slope;
            hessian[(k, k)] += 2.0 * count as f64 * stretch * stretch;
        }
    }
}
