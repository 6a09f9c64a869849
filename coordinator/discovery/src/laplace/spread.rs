//! Points one standard deviation from the mode, which show how far a fit's predictions are uncertain.

use nalgebra::Cholesky;

use crate::laplace::fit::LaplaceFit;
use crate::settings::Roughness;
use statistics::likelihood::Likelihood;

/// Parameter vectors one standard deviation to either side of a fit's mode, a pair for each column of the factor L of the posterior
/// covariance L L' by Laplace's approximation. `None` beyond the limits, and on the second side of a rough model, whose evaluations are
/// dear; no pairs where the posterior has no covariance.
pub(crate) fn spread(fit: &LaplaceFit, likelihood: &Likelihood) -> Vec<[Option<Vec<f64>>; 2]> {
    let covariance = Cholesky::new(fit.quadratic(likelihood).hessian).map(|c| c.inverse());
    let Some(factor) = covariance.and_then(Cholesky::new).map(|c| c.l()) else {
        return Vec::new();
    };
    let mode = &fit.point.position;
    let theta = |column: usize, side: f64| {
        let position = mode
            .iter()
            .enumerate()
            .map(|(k, t)| t + side * factor[(k, column)]);
        let position: Vec<f64> = position.collect();
        fit.frame.holds(&position).then(|| fit.frame.theta(&position))
    };
    (0..mode.len())
        .map(|column| {
            let above = theta(column, 1.0);
            let is_enough = above.is_some() && fit.frame.roughness == Roughness::Rough;
            let below = if is_enough { None } else { theta(column, -1.0) };
            [above, below]
        })
        .collect()
}
