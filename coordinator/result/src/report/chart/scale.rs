//! Choice of a linear or logarithmic scale for a parameter.

use job::FreeParameter;

use super::axis::AxisScale;

/// Draws over more than this factor are drawn against equal ratios, where the prior is made of ratios too.
const WIDE: f64 = 10.0;

/// The scale that suits a parameter's draws.
pub(super) fn scale(parameter: &FreeParameter, draws: &[f64]) -> AxisScale {
    // Only priors in ln x have a coordinate of their own.
    let in_ratios = parameter.marginal.coordinate(2.0) < 1.0;
    let low = draws.iter().copied().fold(f64::INFINITY, f64::min);
    let high = draws.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if in_ratios && low > 0.0 && high > WIDE * low {
        AxisScale::Log
    } else {
        AxisScale::Linear
    }
}

#[cfg(test)]
mod tests {
    use statistics::{Distribution, Marginal};

    use super::*;

    #[test]
    fn only_wide_draws_of_a_prior_in_ratios_are_drawn_as_ratios() {
        let parameter = |distribution| FreeParameter {
            name: "k_phi".into(),
            unit: "1".into(),
            marginal: Marginal::new(distribution, None).unwrap(),
        };
        let ratios = parameter(Distribution::Loguniform {
            lower: 1.0,
            upper: 1e6,
        });
        let steps = parameter(Distribution::Uniform {
            lower: 1.0,
            upper: 1e6,
        });
        assert_eq!(scale(&ratios, &[1.0, 20.0]), AxisScale::Log);
        assert_eq!(scale(&ratios, &[1.0, 2.0]), AxisScale::Linear);
        assert_eq!(scale(&steps, &[1.0, 20.0]), AxisScale::Linear);
    }
}
