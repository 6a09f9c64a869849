//! Reduction of draws and digits to what a figure needs.

use crate::finished_calibration::FinishedCalibration;

/// Maximum number of draws that a density is estimated from.
const DRAWS: usize = 2000;

/// Returns the draws of every parameter; if there are more than [`DRAWS`], that many equally spaced ones.
pub(super) fn thinned_draws(sample: &FinishedCalibration) -> Vec<Vec<f64>> {
    let count = sample.posterior().len();
    let kept: Vec<usize> = (0..count.min(DRAWS))
        .map(|k| k * count / count.min(DRAWS))
        .collect();
    let draws = |i: usize| kept.iter().map(|&k| sample.posterior()[k].theta[i]).collect();
    (0..sample.spec.parameters.len()).map(draws).collect()
}

/// Rounds a number to five significant digits; zero has no sign.
pub(super) fn five_digits(x: f64) -> f64 {
    format!("{x:.4e}").parse().unwrap_or(x) + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn few_draws_are_all_kept_and_many_are_equally_spaced() {
        let mut calibration = fixture::calibration();
        assert_eq!(thinned_draws(&calibration)[0], calibration.draws(0));
        let draws = calibration.posterior().to_vec();
        fixture::sampled(&mut calibration).draws = (0..125).flat_map(|_| draws.clone()).collect();
        let thinned = thinned_draws(&calibration);
        assert_eq!(thinned[0].len(), 2000);
        let all = calibration.draws(0);
        assert_eq!(thinned[0][..4], [all[0], all[2], all[5], all[7]]);
    }

    #[test]
    fn five_digits_are_kept() {
        for (x, rounded) in [
            (1.234_567, 1.2346),
            (-0.000_123_456_7, -0.000_123_46),
            (-0.0, 0.0),
        ] {
            assert_eq!(five_digits(x).to_bits(), f64::to_bits(rounded));
        }
    }
}
