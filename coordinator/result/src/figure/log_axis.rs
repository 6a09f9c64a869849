//! The choice of a logarithmic axis for a parameter.

use statistics::Marginal;

/// Ratio of largest to smallest draw above which the axis is logarithmic, if the prior is defined in the logarithm.
const WIDE: f64 = 10.0;

/// Returns whether the axis of a parameter is logarithmic: its prior is defined in the logarithm, and its draws span a wide range.
pub fn is_logarithmic(prior: &Marginal, draws: &[f64]) -> bool {
    let min = draws.iter().copied().fold(f64::INFINITY, f64::min);
    let max = draws.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // The coordinate of a prior differs from x only if the prior is defined in ln x.
    let in_ratios = prior.coordinate(2.0) < 1.0;
    in_ratios && min > 0.0 && max > WIDE * min
}

#[cfg(test)]
mod tests {
    use statistics::Distribution;

    use super::*;

    #[test]
    fn wide_draws_of_a_prior_in_the_logarithm_have_a_logarithmic_axis() {
        let lognormal = Distribution::Lognormal {
            median: 1.0,
            factor: 3.0,
        };
        let uniform = Distribution::Uniform {
            lower: 0.0,
            upper: 99.0,
        };
        let [lognormal, uniform] = [lognormal, uniform].map(|prior| Marginal::new(prior, None).unwrap());
        assert!(is_logarithmic(&lognormal, &[0.5, 6.0]));
        assert!(!is_logarithmic(&lognormal, &[0.5, 4.0]) && !is_logarithmic(&lognormal, &[0.0, 6.0]));
        assert!(!is_logarithmic(&uniform, &[0.5, 6.0]));
    }
}
