//! The missing law of a system as a piecewise linear curve.

use equation::{Host, LocatedCurve};

use super::dynamic_system::{DynamicSystem, Experiment};
use super::least_squares::{Coordinate, fit};

/// A law that was fitted as a curve, together with the parameters of its system.
#[derive(Debug, Clone)]
pub struct LocatedLaw {
    pub curve: LocatedCurve,
    pub knots: Vec<f64>,
    pub values: Vec<f64>,
    pub parameters: Vec<f64>,
    /// Half the squares of the residuals.
    pub misfit: f64,
}

/// Returns the value of a piecewise linear curve, which goes on straight beyond its ends.
pub fn interpolated(knots: &[f64], values: &[f64], at: f64) -> f64 {
    let right = knots
        .partition_point(|knot| *knot <= at)
        .clamp(1, knots.len() - 1);
    let left = right - 1;
    let share = (at - knots[left]) / (knots[right] - knots[left]);
    values[left] + share * (values[right] - values[left])
}

/// Fits the law of a system at knots; `None` if no start leads to a fit whose covariance is positive definite.
///
/// # Arguments
/// - `size`: a guess of the law's magnitude; its values have independent normal priors with ten times this sd.
pub fn located(
    system: &DynamicSystem,
    experiments: &[Experiment],
    knots: &[f64],
    size: f64,
) -> Option<LocatedLaw> {
    let count = knots.len();
    let wide = |_: &f64| Coordinate {
        mean: 0.0,
        sd: 10.0 * size,
        scale: size,
    };
    let coordinates: Vec<Coordinate> = knots.iter().map(wide).chain(system.coordinates()).collect();
    let residuals = |place: &[f64]| {
        let (values, parameters) = place.split_at(count);
        system.residuals(|x| interpolated(knots, values, x), parameters, experiments)
    };
    let last = knots[count - 1];
    let shapes: [fn(f64) -> f64; 3] = [|_| 1.0, |share| share, |share| share.sqrt()];
    let starts = shapes
        .iter()
        .flat_map(|shape| [0.3, 1.0].map(|factor| (shape, factor)));
    let fits = starts.filter_map(|(shape, factor)| {
        let values = knots
            .iter()
            .map(|knot| factor * size * shape((knot / last).max(0.0)));
        let start: Vec<f64> = values
            .chain(system.priors.iter().map(|[mean, _]| *mean))
            .collect();
        fit(&coordinates, start, 30, residuals)
    });
    let best = fits.min_by(|a, b| a.objective.total_cmp(&b.objective))?;
    let inverse = best.hessian.cholesky()?.inverse();
    let covariance: Vec<f64> = (0..count)
        .flat_map(|j| (0..count).map(move |k| (j, k)))
        .map(|at| inverse[at])
        .collect();
    let (values, parameters) = best.place.split_at(count);
    Some(LocatedLaw {
        curve: LocatedCurve::of_knots(Host::Addition, knots, values, &covariance, false).ok()?,
        knots: knots.to_vec(),
        values: values.to_vec(),
        parameters: parameters.to_vec(),
        misfit: best.misfit,
    })
}
