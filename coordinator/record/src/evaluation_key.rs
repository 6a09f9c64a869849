//! The permanent number of an evaluation.

/// Numbers from here on are final draws: the fitted runs of draw k are number 2k, its holdout runs 2k + 1.
/// Below, they are the sampler's or the fit's.
pub const PREDICTIONS_FROM: u64 = 1 << 40;

/// Number of the evaluation at the most probable parameters.
pub const LIKELIEST: u64 = 2 * PREDICTIONS_FROM;

/// Numbers from here on are single holdout runs of final draws: run r of draw k is number `HOLDOUT_RUNS_FROM + 65536 r + k`.
pub const HOLDOUT_RUNS_FROM: u64 = 3 * PREDICTIONS_FROM;

/// Bound on the number of final draws.
const MAX_DRAWS: u64 = 1 << 16;

/// Purpose of an evaluation. Its number depends only on the job, so it survives a restart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EvaluationKey {
    /// A proposal of the sampler or the fit: number = round x width + particle, the width of [`AlgorithmSettings::width`].
    ///
    /// [`AlgorithmSettings::width`]: job::AlgorithmSettings::width
    Sampling {
        /// The round, counted from 0.
        round: u64,
        /// Index of the particle.
        particle: usize,
    },
    /// The fitted runs at the most probable parameters, with histories if the model is time-dependent.
    Likeliest,
    /// A final draw of the posterior.
    Prediction {
        /// Index among the draws.
        draw: usize,
        /// Whether the holdout runs of the draw are evaluated, or the fitted runs. They are separate, so that a rejected holdout run does
        /// not reject the fitted ones.
        holdout: bool,
    },
    /// One holdout run of a final draw whose holdout runs the model refused together.
    HoldoutRun {
        /// Index among the draws.
        draw: usize,
        /// Index among the holdout runs.
        run: usize,
    },
}

impl EvaluationKey {
    /// Returns the number of this evaluation in a calibration with rounds of this width.
    pub fn number(self, width: usize) -> u64 {
        match self {
            EvaluationKey::Sampling { round, particle } => round * width as u64 + particle as u64,
            EvaluationKey::Likeliest => LIKELIEST,
            EvaluationKey::Prediction { draw, holdout } => {
                PREDICTIONS_FROM + 2 * draw as u64 + u64::from(holdout)
            }
            EvaluationKey::HoldoutRun { draw, run } => {
                HOLDOUT_RUNS_FROM + run as u64 * MAX_DRAWS + draw as u64
            }
        }
    }

    /// Returns the evaluation that has a number.
    pub fn from_number(number: u64, width: usize) -> Self {
        match number.checked_sub(PREDICTIONS_FROM) {
            Some(_) if number >= HOLDOUT_RUNS_FROM => EvaluationKey::HoldoutRun {
                draw: ((number - HOLDOUT_RUNS_FROM) % MAX_DRAWS) as usize,
                run: ((number - HOLDOUT_RUNS_FROM) / MAX_DRAWS) as usize,
            },
            Some(_) if number >= LIKELIEST => EvaluationKey::Likeliest,
            Some(k) => EvaluationKey::Prediction {
                draw: (k / 2) as usize,
                holdout: k % 2 == 1,
            },
            None => EvaluationKey::Sampling {
                round: number / width as u64,
                particle: (number % width as u64) as usize,
            },
        }
    }

    /// Returns whether only holdout runs are evaluated, of parameters whose fitted runs are another evaluation.
    pub fn is_of_holdout(self) -> bool {
        matches!(
            self,
            EvaluationKey::Prediction { holdout: true, .. } | EvaluationKey::HoldoutRun { .. }
        )
    }

    /// Returns the first number that a result of this evaluation may influence: the one after its round.
    pub fn round_end(number: u64, width: usize) -> u64 {
        match EvaluationKey::from_number(number, width) {
            EvaluationKey::Sampling { round, .. } => (round + 1) * width as u64,
            EvaluationKey::Prediction { .. } | EvaluationKey::Likeliest => HOLDOUT_RUNS_FROM,
            EvaluationKey::HoldoutRun { .. } => i64::MAX as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_and_key_are_inverse() {
        for number in [
            0,
            999,
            1000,
            123_456,
            PREDICTIONS_FROM,
            PREDICTIONS_FROM + 199,
            LIKELIEST,
            HOLDOUT_RUNS_FROM,
            HOLDOUT_RUNS_FROM + 17 * MAX_DRAWS + 199,
        ] {
            assert_eq!(EvaluationKey::from_number(number, 1000).number(1000), number);
        }
    }

    #[test]
    fn what_follows_from_a_round_comes_behind_it() {
        let end = |number| EvaluationKey::round_end(number, 1000);
        assert_eq!((end(0), end(999), end(1000)), (1000, 1000, 2000));
        assert_eq!(
            (end(PREDICTIONS_FROM + 3), end(LIKELIEST)),
            (HOLDOUT_RUNS_FROM, HOLDOUT_RUNS_FROM)
        );
        assert!(end(HOLDOUT_RUNS_FROM + 5) > HOLDOUT_RUNS_FROM + MAX_DRAWS * MAX_DRAWS);
    }
}
