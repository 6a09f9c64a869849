//! Integrate likelihood times prior over a parabola, in coordinates in which the prior is standard normal.

use nalgebra::{Cholesky, DVector};

use inference::lm::QuadraticModel;
use statistics::prior::normal;

/// ln of the integral of `N(t; 0, I) exp(log-likelihood)` where `-log-likelihood + |t|^2/2` is the parabola of value f:
/// `-f + g' H^-1 g / 2 - ln det(H) / 2`, and for each half-normal coordinate of mean m and variance v besides `ln 2 Phi(m / sqrt v)`.
///
/// # Arguments
/// - `halves`: the coordinates that have one sign only; several are taken to be truncated independently of each other.
///
/// # Returns
/// Nats; `None` where the parabola has no least.
///
/// # Validity
/// Exact for a linear model with normal errors, truncation of one coordinate included; else Laplace's approximation. At the least of the parabola
/// the gradient is zero but for a strength at its bound, whose slope is what is left of it. Checked by
/// `discovery::evidence_of_a_linear_extension_is_exact`.
pub(crate) fn log_evidence(parabola: &QuadraticModel, value: f64, halves: &[usize]) -> Option<f64> {
    let cholesky = Cholesky::new(parabola.hessian.clone())?;
    let gradient = DVector::from_column_slice(&parabola.gradient);
    let to_least = cholesky.solve(&gradient);
    let lower = cholesky.l();
    let half_log_determinant: f64 = (0..gradient.len()).map(|k| libm::log(lower[(k, k)])).sum();
    let whole = -value + 0.5 * gradient.dot(&to_least) - half_log_determinant;
    if halves.is_empty() {
        return Some(whole);
    }
    let covariance = cholesky.inverse();
    let share = |&k: &usize| {
        // -lower is where the coordinate stands above its bound.
        let mean = -parabola.lower[k] - to_least[k];
        log_share_above_zero(mean, covariance[(k, k)])
    };
    Some(whole + halves.iter().map(share).sum::<f64>())
}

/// `ln 2 Phi(mean / sqrt(variance))`: what a half-normal prior gains over the normal one.
pub(crate) fn log_share_above_zero(mean: f64, variance: f64) -> f64 {
    libm::log(2.0) + normal::log_cdf(mean / variance.sqrt())
}

/// ln sum exp; minus infinity for nothing.
pub(crate) fn log_sum_exp(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let highest = values.clone().fold(f64::NEG_INFINITY, f64::max);
    if !highest.is_finite() {
        return highest;
    }
    highest + libm::log(values.map(|v| libm::exp(v - highest)).sum())
}
