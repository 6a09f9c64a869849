//! The damping of the steps.

/// Dampings of neighbouring trials differ by this factor.
const SPREAD: f64 = 8.0;
/// The dampings of a round, in units of the smallest.
const TRIALS: [f64; 3] = [1.0, SPREAD, SPREAD * SPREAD];
/// The initial damping: a tenth of the curvature.
const FIRST: f64 = 0.1;
/// The smallest damping; a damping below this has no effect.
const MIN_DAMPING: f64 = 1e-9;

/// The damping of the next trials.
#[derive(Debug, Clone, Copy)]
pub(super) struct Damping {
    lowest: f64,
    growth: f64,
    undamped: bool,
}

impl Default for Damping {
    fn default() -> Self {
        Self {
            lowest: FIRST,
            growth: 2.0,
            undamped: true,
        }
    }
}

impl Damping {
    /// Returns the dampings of a round: none, then increasing ones.
    pub(super) fn trials(&self) -> Vec<f64> {
        let whole = self.undamped.then_some(0.0);
        let damped = TRIALS.into_iter().map(|factor| self.lowest * factor);
        whole.into_iter().chain(damped).collect()
    }

    /// Sets the damping after a step whose decrease is `ratio` times the predicted one.
    ///
    /// Nielsen's rule, `damping * max(1/3, 1 - (2 ratio - 1)^3)`, with 1/[`SPREAD`] in place of 1/3 because several
    /// dampings are tried at once.
    pub(super) fn accept(&mut self, damping: f64, ratio: f64) {
        let from = damping.max(self.lowest / SPREAD);
        let miss = 2.0 * ratio - 1.0;
        let factor = (1.0 - miss * miss * miss).clamp(1.0 / SPREAD, SPREAD);
        *self = Self {
            lowest: (from * factor).max(MIN_DAMPING),
            ..Self::default()
        };
    }

    /// Sets the damping after a round without a decrease: above all that were tried, and with a factor that doubles each time.
    pub(super) fn reject(&mut self) {
        self.lowest *= TRIALS[TRIALS.len() - 1] * self.growth;
        self.growth *= 2.0;
        self.undamped = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trials_without_gain_are_never_tried_again() {
        let mut damping = Damping::default();
        let mut longest = f64::NEG_INFINITY;
        for _ in 0..5 {
            let trials = damping.trials();
            assert!(trials.iter().all(|&t| t > longest), "{trials:?}");
            longest = trials.last().copied().unwrap();
            damping.reject();
        }
    }

    #[test]
    fn a_good_step_lessens_the_damping_and_a_poor_one_does_not() {
        let after = |ratio| {
            let mut damping = Damping::default();
            damping.accept(0.8, ratio);
            damping.lowest
        };
        assert!(after(1.0) < 0.8 && after(0.1) > 0.8);
    }
}
