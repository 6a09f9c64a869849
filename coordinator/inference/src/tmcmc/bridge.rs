//! Estimate the ratio of two neighbouring normalising constants from the states of both.

/// Bisections of the root; the bracket shrinks by 2^-60.
const BISECTIONS: usize = 60;

/// The ratio Z(after) / Z(before) and each state's share of its error.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bridge {
    pub(super) log_ratio: f64,
    pub(super) errors_before: Vec<f64>,
    pub(super) errors_after: Vec<f64>,
}

impl Bridge {
    /// Bridge between pools whose targets differ by the factor exp(step l).
    ///
    /// `mean_before f(step l - r) = mean_after f(r - step l)` with f(x) = 1 / (1 + exp(-x)) (Bennett 1976,
    /// J. Comput. Phys. 22:245, both pools given equal weight). It uses the later pool too, so what the
    /// earlier one missed does not go unnoticed.
    pub(super) fn between(before: &[f64], after: &[f64], step: f64) -> Self {
        let scaled = |values: &[f64]| values.iter().map(|l| step * l).collect::<Vec<f64>>();
        let (before, after) = (scaled(before), scaled(after));
        let all = || before.iter().chain(&after);
        let mut low = all().fold(f64::INFINITY, |low, &x| low.min(x));
        let mut high = all().fold(f64::NEG_INFINITY, |high, &x| high.max(x));
        let forward = |r: f64| mean(before.iter().map(|x| logistic(x - r)));
        let backward = |r: f64| mean(after.iter().map(|x| logistic(r - x)));
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if forward(middle) > backward(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        let r = 0.5 * (low + high);
        let (level_before, level_after) = (forward(r), backward(r));
        let slope = mean(before.iter().map(|x| logistic(x - r) * logistic(r - x)))
            + mean(after.iter().map(|x| logistic(x - r) * logistic(r - x)));
        let errors_before = before
            .iter()
            .map(|x| (logistic(x - r) - level_before) / (before.len() as f64 * slope))
            .collect();
        let errors_after = after
            .iter()
            .map(|x| (level_after - logistic(r - x)) / (after.len() as f64 * slope))
            .collect();
        Self {
            log_ratio: r,
            errors_before,
            errors_after,
        }
    }
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-x))
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// l is 0 or 1; one in four is 1 before, so the ratio for a step of ln 3 is (3 + 3) / 4 = 1.5 and half
    /// are 1 after.
    #[test]
    fn the_ratio_of_exact_populations_is_exact() {
        let step = libm::log(3.0);
        let bridge = Bridge::between(&[0.0, 0.0, 0.0, 1.0], &[0.0, 1.0], step);
        assert!(
            (bridge.log_ratio - libm::log(1.5)).abs() < 1e-12,
            "{}",
            bridge.log_ratio
        );
        let sum: f64 = bridge.errors_before.iter().chain(&bridge.errors_after).sum();
        assert!(sum.abs() < 1e-12);
    }

    /// The same population taken as both sides is between the one-sided answers: a sign error is not.
    #[test]
    fn an_unmoved_population_gives_the_mean_of_both_sides() {
        let bridge = Bridge::between(&[0.0, 1.0, 4.0], &[0.0, 1.0, 4.0], 0.5);
        let forward = libm::log((1.0 + libm::exp(0.5) + libm::exp(2.0)) / 3.0);
        let backward = -libm::log((1.0 + libm::exp(-0.5) + libm::exp(-2.0)) / 3.0);
        assert!(backward < bridge.log_ratio && bridge.log_ratio < forward);
    }
}
