//! Draws of the posterior by Laplace's approximation.

use nalgebra::{Cholesky, DVector};

use crate::laplace::fit::LaplaceFit;
use statistics::likelihood::Likelihood;
use statistics::rng::Stream;

/// Random streams of the draws.
const STAGE: u64 = 1 << 43;

/// Returns the mode of a fit, then draws from its posterior; draws beyond the limits are left out.
pub(crate) fn draws(
    fit: &LaplaceFit,
    likelihood: &Likelihood,
    seed: u64,
    number: u64,
    count: usize,
) -> Vec<Vec<f64>> {
    let factor = Cholesky::new(fit.quadratic(likelihood).hessian).map(|c| c.inverse());
    let factor = factor.and_then(Cholesky::new).map(|c| c.l());
    let mode = DVector::from_column_slice(&fit.point.position);
    let draw = |k: usize| {
        let z = Stream::new(seed, STAGE, number, k as u64).normals(mode.len());
        let moved = factor.as_ref().map(|l| l * DVector::from_vec(z))?;
        let position: Vec<f64> = (&mode + moved).iter().copied().collect();
        fit.frame.holds(&position).then(|| fit.frame.theta(&position))
    };
    std::iter::once(fit.theta())
        .chain((1..count).filter_map(draw))
        .collect()
}
