//! The quadratic expansion of the negative log posterior.

use nalgebra::DMatrix;

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::noise;
use crate::laplace::point::FitPoint;
use crate::laplace::strength_prior;
use inference::lm::QuadraticModel;
use statistics::likelihood::Likelihood;

/// Returns the Gauss-Newton expansion of the negative log posterior about a point.
///
/// # Arguments
/// - `columns`: the derivatives of the predicted values, one column for each coordinate.
pub(crate) fn quadratic(
    frame: &NormalFrame,
    likelihood: &Likelihood,
    point: &FitPoint,
    columns: &[Vec<f64>],
) -> QuadraticModel {
    let count = point.position.len();
    let mut gradient = point.position.clone();
    let mut hessian = DMatrix::identity(count, count);
    // An evaluated point has a likelihood, so its values can be whitened.
    if let Ok(whitening) = likelihood.whitening(&point.values, &frame.theta(&point.position)) {
        let scaled: Vec<Vec<f64>> = columns.iter().map(|column| whitening.apply(column)).collect();
        for k in 0..count {
            gradient[k] -= whitening.slope(&scaled[k]);
            for l in 0..=k {
                let curvature = whitening.curvature(&scaled[k], &scaled[l]);
                hessian[(k, l)] += curvature;
                if l < k {
                    hessian[(l, k)] += curvature;
                }
            }
        }
    }
    noise::add(frame, likelihood, point, &mut gradient, &mut hessian);
    strength_prior::add(frame, &point.position, &mut gradient, &mut hessian);
    let (lower, upper) = frame.room(&point.position);
    QuadraticModel {
        gradient,
        hessian,
        lower,
        upper,
        held: vec![false; count],
    }
}
