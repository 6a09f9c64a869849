//! The bridge estimate of the ratio of two neighbouring normalising constants.

use crate::tmcmc::transition::Weights;

/// Maximum number of iterations for the ratio; Newton's method takes about five.
const MAX_STEPS: usize = 60;
/// Change of the ratio by a step, relative to the larger of its size and 1, below which the iteration ends.
const TOLERANCE: f64 = 1e-13;

/// The ratio Z(after) / Z(before) and each state's share of its error.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bridge {
    pub(crate) log_ratio: f64,
    pub(crate) errors_before: Vec<f64>,
    pub(crate) errors_after: Vec<f64>,
}

impl Bridge {
    /// Computes the bridge between pools whose targets differ by the factor exp(step l).
    ///
    /// `mean_before f(step l - r) = mean_after f(r - step l)` with f(x) = 1 / (1 + exp(-x)), both pools given equal
    /// weight. It uses the later pool too, so a region that the earlier one missed still counts.
    ///
    /// # Source
    /// Bennett 1976, J. Comput. Phys. 22:245, doi:10.1016/0021-9991(76)90078-4; Meng & Wong 1996, Statistica Sinica 6:831.
    pub(crate) fn between(before: &[f64], after: &[f64], step: f64) -> Self {
        let scaled = |values: &[f64]| values.iter().map(|l| step * l).collect::<Vec<f64>>();
        let (before, after) = (scaled(before), scaled(after));
        let all = || before.iter().chain(&after);
        let mut low = all().fold(f64::INFINITY, |low, &x| low.min(x));
        let mut high = all().fold(f64::NEG_INFINITY, |high, &x| high.max(x));
        // Newton's steps from the one-sided estimate of the earlier pool, kept in the bracket.
        let mut r = Weights::new(&before, 1.0).log_mean;
        let mut balance = Balance::at(&before, &after, r);
        for _ in 0..MAX_STEPS {
            if balance.forward > balance.backward {
                low = low.max(r);
            } else {
                high = high.min(r);
            }
            let newton = r + (balance.forward - balance.backward) / balance.slope;
            let next = if low <= newton && newton <= high {
                newton
            } else {
                0.5 * (low + high)
            };
            let change = (next - r).abs();
            r = next;
            balance = Balance::at(&before, &after, r);
            if change <= TOLERANCE * r.abs().max(1.0) {
                break;
            }
        }
        let Balance {
            forward: level_before,
            backward: level_after,
            slope,
        } = balance;
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

/// Both sides of the bridge's equation at a trial ratio, and how fast their difference falls.
struct Balance {
    forward: f64,
    backward: f64,
    slope: f64,
}

impl Balance {
    fn at(before: &[f64], after: &[f64], r: f64) -> Self {
        let side = |values: &[f64], sign: f64| {
            let (mut level, mut slope) = (0.0, 0.0);
            for x in values {
                let p = logistic(sign * (x - r));
                level += p;
                slope += p * (1.0 - p);
            }
            let count = values.len() as f64;
            (level / count, slope / count)
        };
        let ((forward, rising), (backward, falling)) = (side(before, 1.0), side(after, -1.0));
        Self {
            forward,
            backward,
            slope: rising + falling,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// l is 0 or 1; one in four is 1 before, so the ratio for a step of ln 3 is (3 + 3) / 4 = 1.5 and half are 1 after.
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

    /// For one population on both sides the ratio lies between the one-sided estimates; with a sign error it does not.
    #[test]
    fn an_unmoved_population_gives_the_mean_of_both_sides() {
        let bridge = Bridge::between(&[0.0, 1.0, 4.0], &[0.0, 1.0, 4.0], 0.5);
        let forward = libm::log((1.0 + libm::exp(0.5) + libm::exp(2.0)) / 3.0);
        let backward = -libm::log((1.0 + libm::exp(-0.5) + libm::exp(-2.0)) / 3.0);
        assert!(backward < bridge.log_ratio && bridge.log_ratio < forward);
    }
}
