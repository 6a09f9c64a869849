//! The gradient and curvature of the likelihood along inferred noise sds and correlation lengths, on which the predicted values do not depend.

use nalgebra::DMatrix;

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::point::FitPoint;
use statistics::likelihood::{ErrorSd, Likelihood};

/// Half width of the central differences; the density is smooth and accurate to rounding.
const DIFFERENCE: f64 = 1e-3;

/// Lists the coordinates that are sds or correlation lengths: those of noise with the number of data that share them, those of common
/// errors without.
pub(crate) fn coordinates(likelihood: &Likelihood) -> Vec<(usize, Option<usize>)> {
    let data = likelihood.data().iter();
    let mut parameters: Vec<usize> = data.filter_map(|datum| datum.sd.parameter()).collect();
    parameters.sort_unstable();
    let groups = parameters.chunk_by(|a, b| a == b);
    let mut coordinates: Vec<(usize, Option<usize>)> =
        groups.map(|group| (group[0], Some(group.len()))).collect();
    for error in likelihood.common() {
        for parameter in error.size.hyperparameters().filter_map(ErrorSd::parameter) {
            if !coordinates.iter().any(|(sd, _)| *sd == parameter) {
                coordinates.push((parameter, None));
            }
        }
    }
    coordinates
}

/// Adds gradient and curvature of `-log-likelihood` along the sds. The curvature is the expected one, `2 N (d ln sd / dt)^2`, for N
/// data that share a noise, and the actual one for a common error, where it is positive: that likelihood is flat towards 0.
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
        let curvature = match count {
            Some(count) => {
                let stretch = libm::log(high / low) / (2.0 * DIFFERENCE);
                2.0 * count as f64 * stretch * stretch
            }
            None => {
                let (_, middle) = at(0.0);
                ((2.0 * middle - before - after) / (DIFFERENCE * DIFFERENCE)).max(0.0)
            }
        };
        if slope.is_finite() && curvature.is_finite() {
            gradient[k] -= slope;
            hessian[(k, k)] += curvature;
        }
    }
}
