//! `RunSurface`: the response surface of one run and channel, and its error.

use inference::response_surface::OutputSurface;
use shared::channel::Channel;

/// Largest rounding error of a coefficient, as a share of the output's standard deviation over the draws.
const ROUNDING: f64 = 5e-5;

/// The response surface of one run and channel.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct RunSurface {
    /// Name of the run.
    pub run: String,
    /// Channel, by its name without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Coefficients of the polynomial in the unit of the channel: the constant, the slope along each whitened coordinate, then for a
    /// quadratic surface those of the products `u_i u_j` with `i <= j`, row by row. They are rounded to a ten-thousandth of the output's
    /// standard deviation over the draws.
    pub coefficients: Vec<f64>,
}

/// The error of the surface of one run and channel.
#[derive(Debug, Clone, Copy)]
pub(super) struct OutputError {
    /// Channel of the output.
    pub channel: Channel,
    /// Sum over the draws of the squared errors, each draw left out of the fit.
    pub sum_of_squares: f64,
    /// Number of the draws.
    pub draws: usize,
    /// Noise standard deviation of the run and channel; `None` if it is unknown.
    pub noise_sd: Option<f64>,
}

impl OutputError {
    /// Takes the error from the fit of an output.
    pub(super) fn new(channel: Channel, noise_sd: Option<f64>, surface: &OutputSurface) -> Self {
        let errors = &surface.left_out_errors;
        OutputError {
            channel,
            sum_of_squares: errors.iter().map(|error| error * error).sum(),
            draws: errors.len(),
            noise_sd,
        }
    }
}

/// Rounds the coefficients of an output.
///
/// The whitened coordinates have unit variance, so that the root of the sum of squares of all but the constant is close to the standard
/// deviation of the output.
pub(super) fn rounded(coefficients: &[f64]) -> Vec<f64> {
    let spread = coefficients[1..].iter().map(|c| c * c).sum::<f64>().sqrt();
    if spread <= 0.0 {
        return coefficients.to_vec();
    }
    let decimals = -libm::floor(libm::log10(2.0 * ROUNDING * spread));
    let decimals = decimals.clamp(0.0, 30.0) as usize;
    let round = |c: &f64| format!("{c:.decimals$}").parse().unwrap_or(*c) + 0.0;
    coefficients.iter().map(round).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_keep_a_ten_thousandth_of_the_spread() {
        let exact = [12.345_678_9, 0.3, -0.4, 0.000_012_3];
        assert_eq!(rounded(&exact), [12.345_68, 0.3, -0.4, 0.000_01]);
        let sinkage = [0.012_345_678_901, 0.001_234_567_89];
        assert_eq!(rounded(&sinkage), [0.012_345_7, 0.001_234_6]);
        assert_eq!(rounded(&[7.123_456, 0.0]), [7.123_456, 0.0]);
        assert_eq!(rounded(&[1e6, 3e6])[1].to_bits(), 3e6_f64.to_bits());
    }
}
