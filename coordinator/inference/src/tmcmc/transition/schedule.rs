//! The schedule of the stages: the next tempering exponent.

use super::weights::Weights;

/// The search ends at this width of the bracket, or at this excess of the coefficient of variation, both of logarithms.
const TOLERANCE: f64 = 1e-10;
/// Maximum number of trials, far more than false position takes.
const MAX_TRIALS: usize = 200;

/// Returns the step of the exponent at which the weights of `log_likelihoods` have the coefficient of variation `target`, or
/// `remaining` = 1 - exponent if that comes first.
///
/// The coefficient rises with the step, nearly in proportion where it is small, so false position on the logarithms of both finds
/// it in a few trials. The scale is logarithmic because the first step can be 1e-10 or less. The log-likelihoods are finite and
/// not empty.
///
/// # Source
/// Dowell & Jarratt 1971, BIT 11:168, doi:10.1007/BF01934364 (Illinois variant of false position).
pub(crate) fn exponent_step(log_likelihoods: &[f64], remaining: f64, target: f64) -> f64 {
    let cov = |step: f64| Weights::new(log_likelihoods, step).cov;
    if cov(remaining) <= target {
        return remaining;
    }
    let max = log_likelihoods
        .iter()
        .fold(f64::NEG_INFINITY, |max, &l| max.max(l));
    let min = log_likelihoods.iter().fold(f64::INFINITY, |min, &l| min.min(l));
    // Weights between exp(-c) and 1 vary by at most sinh(c/2), which is below `target` for c = min(target, 1).
    let lowest = target.min(1.0) / (max - min).min(f64::MAX);
    let excess = |log_step: f64| libm::log(cov(libm::exp(log_step)) / target);
    let (mut low, mut high) = (libm::log(lowest.min(remaining)), libm::log(remaining));
    let (mut below, mut above) = (excess(low), excess(high));
    let mut last_was_above = None;
    for _ in 0..MAX_TRIALS {
        let position = high - above * (high - low) / (above - below);
        // Bisect where false position gives no number or no progress: a coefficient of 0 has no logarithm.
        let trial = if low < position && position < high {
            position
        } else {
            0.5 * (low + high)
        };
        let value = excess(trial);
        // The value at an end that stays twice is halved, or the other end would creep.
        let stayed = last_was_above.replace(value > 0.0) == Some(value > 0.0);
        if value > 0.0 {
            (high, above) = (trial, value);
            below *= if stayed { 0.5 } else { 1.0 };
        } else {
            (low, below) = (trial, value);
            above *= if stayed { 0.5 } else { 1.0 };
        }
        if high - low <= TOLERANCE || value.abs() <= TOLERANCE {
            low = trial;
            break;
        }
    }
    libm::exp(low).min(remaining)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// l = -x^2/2 with x uniform on [-a, a]: the weights are Gaussian in x, and for a wide box
    /// 1 + cov^2 = a sqrt(step / pi), so cov = 1 at step = 4 pi / a^2.
    #[test]
    fn first_exponent_of_a_thin_ridge_is_found() {
        let half_width = 2.5e5;
        let log_likelihoods: Vec<f64> = (0..200_001)
            .map(|i| half_width * (f64::from(i) / 1e5 - 1.0))
            .map(|x| -0.5 * x * x)
            .collect();
        let step = exponent_step(&log_likelihoods, 1.0, 1.0);
        let expected = 4.0 * std::f64::consts::PI / (half_width * half_width);
        assert!((1.9e-10..2.1e-10).contains(&expected));
        assert!((step / expected - 1.0).abs() < 5e-3, "{step} {expected}");
    }

    #[test]
    fn a_flat_likelihood_is_done_in_one_step() {
        assert_eq!(exponent_step(&[-5.0; 7], 0.25, 1.0).to_bits(), 0.25_f64.to_bits());
    }

    /// A sign error turns this asymmetric set into its mirror image, which has another solution.
    #[test]
    fn an_asymmetric_set_has_its_own_step() {
        let few_good: Vec<f64> = (0..100).map(|i| if i < 5 { 0.0 } else { -10.0 }).collect();
        let few_bad: Vec<f64> = (0..100).map(|i| if i < 5 { -10.0 } else { 0.0 }).collect();
        // 5 weights of 1 and 95 of w: cov^2 = 100 (5 + 95 w^2) / (5 + 95 w)^2 - 1 = 1 at w = 0.15206.
        let step = exponent_step(&few_good, 1.0, 1.0);
        let w = libm::exp(-10.0 * step);
        let squared = 100.0 * (5.0 + 95.0 * w * w) / ((5.0 + 95.0 * w) * (5.0 + 95.0 * w)) - 1.0;
        assert!((squared - 1.0).abs() < 1e-6, "{squared}");
        assert_eq!(exponent_step(&few_bad, 1.0, 1.0).to_bits(), 1.0_f64.to_bits());
    }
}
