//! The fit of the base model, from starts that fill the prior.

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::{FitStep, LaplaceFit};
use crate::laplace::point::FitPoint;
use statistics::likelihood::Likelihood;

/// The fit ends once a new Jacobian predicts no gain: every candidate is compared with this fit.
pub(crate) const PLAN: [FitStep; 2] = [FitStep::Rounds { max: 6, trials: 12 }, FitStep::Differences];

/// How many of the starts, the most probable, are fitted.
const COUNT: usize = 3;

/// Starts that fill the prior evenly: Kronecker's sequence with the generalised golden ratio, through the priors' quantiles.
///
/// # Source
/// Roberts 2018, "The unreasonable effectiveness of quasirandom sequences". Checked by `tests::starts_fill_the_prior`.
pub(crate) fn starts(frame: &NormalFrame, count: usize) -> Vec<Vec<f64>> {
    let dimension = frame.dimension();
    let golden = golden_ratio(dimension);
    let fraction = |n: usize, k: usize| {
        let x = 0.5 + n as f64 * libm::pow(golden, -(k as f64 + 1.0));
        x - libm::floor(x)
    };
    let start = |n: usize| {
        let marginals = frame.coordinates.iter().map(|c| &c.marginal).enumerate();
        let theta: Vec<f64> = marginals.map(|(k, m)| m.quantile(fraction(n, k))).collect();
        frame.position(&theta)
    };
    (0..count).map(start).collect()
}

/// The root above 1 of `x^(d+1) = x + 1`.
fn golden_ratio(dimension: usize) -> f64 {
    let power = 1.0 / (dimension as f64 + 1.0);
    (0..64).fold(2.0, |x: f64, _| libm::pow(1.0 + x, power))
}

/// Fits from the best of evaluated starts; none if the model rejected them all.
pub(crate) fn fits(
    frame: &NormalFrame,
    likelihood: &Likelihood,
    plan: &[FitStep],
    evaluated: Vec<(Vec<f64>, Option<Vec<f64>>)>,
) -> Vec<LaplaceFit> {
    let points = evaluated
        .into_iter()
        .filter_map(|(position, values)| FitPoint::new(frame, likelihood, position, values?));
    let mut points: Vec<FitPoint> = points.collect();
    points.sort_by(|a, b| a.value.total_cmp(&b.value));
    points.truncate(COUNT);
    let fit = |point: FitPoint| {
        let columns = vec![vec![0.0; point.values.len()]; frame.dimension()];
        LaplaceFit::new(frame.clone(), point, columns, plan)
    };
    points.into_iter().map(fit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Smoothness;
    use statistics::prior::{Distribution, Marginal, Prior};

    #[test]
    fn starts_fill_the_prior() {
        let uniform = |lower, upper| Marginal::new(Distribution::Uniform { lower, upper }, None).unwrap();
        let frame = NormalFrame::base(
            &Prior::new(vec![uniform(0.0, 1.0), uniform(0.0, 4.0)]),
            Smoothness::Smooth,
        );
        let thetas: Vec<Vec<f64>> = starts(&frame, 32).iter().map(|t| frame.theta(t)).collect();
        for quarter in 0..4 {
            let low = f64::from(quarter);
            let inside = |x: f64| (low..low + 1.0).contains(&x);
            let first = thetas.iter().filter(|x| inside(4.0 * x[0])).count();
            let second = thetas.iter().filter(|x| inside(x[1])).count();
            assert!(
                (7..=10).contains(&first) && (7..=10).contains(&second),
                "{first} {second}"
            );
        }
    }
}
