//! The evidence by Laplace's approximation, in coordinates in which the prior is standard normal.

use nalgebra::{Cholesky, DVector, Dyn};

use inference::lm::QuadraticModel;
use statistics::prior::normal;

/// Returns the log evidence: ln of the integral of `N(t; 0, I) exp(log-likelihood)` where `-log-likelihood + |t|^2/2` is
/// quadratic with value f, gradient g and Hessian H.
///
/// `-f + g' H^-1 g / 2 - ln det(H) / 2`, plus `ln 2 Phi(m / sqrt v)` for each half-normal coordinate of mean m and variance v.
///
/// # Arguments
/// - `halves`: the half-normal coordinates; their truncations are treated as independent.
///
/// # Returns
/// Nats; `None` where the Hessian is not positive definite.
///
/// # Validity
/// Exact for a linear model with normal errors and at most one half-normal coordinate, otherwise Laplace's approximation.
///
/// # Source
/// Kass & Raftery 1995, section 4.1, doi:10.1080/01621459.1995.10476572. Checked by
/// `effect_search::evidence_of_a_linear_extension_is_exact`.
pub(crate) fn log_evidence(quadratic: &QuadraticModel, value: f64, halves: &[usize]) -> Option<f64> {
    let cholesky = Cholesky::new(quadratic.hessian.clone())?;
    let gradient = DVector::from_column_slice(&quadratic.gradient);
    let to_mode = cholesky.solve(&gradient);
    let whole = -value + 0.5 * gradient.dot(&to_mode) + log_volume_of(&cholesky);
    if halves.is_empty() {
        return Some(whole);
    }
    let covariance = cholesky.inverse();
    let share = |&k: &usize| {
        // The coordinate lies -lower above its bound.
        let mean = -quadratic.lower[k] - to_mode[k];
        log_share_above_zero(mean, covariance[(k, k)])
    };
    Some(whole + halves.iter().map(share).sum::<f64>())
}

/// Returns `-ln det(H) / 2`; `None` where the Hessian is not positive definite.
pub(crate) fn log_volume(quadratic: &QuadraticModel) -> Option<f64> {
    Some(log_volume_of(&Cholesky::new(quadratic.hessian.clone())?))
}

fn log_volume_of(cholesky: &Cholesky<f64, Dyn>) -> f64 {
    let lower = cholesky.l_dirty();
    -(0..lower.nrows()).map(|k| libm::log(lower[(k, k)])).sum::<f64>()
}

/// Returns `ln 2 Phi(mean / sqrt(variance))`: the evidence under a half-normal prior over that under the normal one.
fn log_share_above_zero(mean: f64, variance: f64) -> f64 {
    libm::log(2.0) + normal::log_cdf(mean / variance.sqrt())
}

/// Returns `ln sum exp`; minus infinity for an empty sum.
pub(crate) fn log_sum_exp(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let highest = values.clone().fold(f64::NEG_INFINITY, f64::max);
    if !highest.is_finite() {
        return highest;
    }
    highest + libm::log(values.map(|v| libm::exp(v - highest)).sum())
}
