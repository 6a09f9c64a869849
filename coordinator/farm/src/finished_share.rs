//! The finished share of a calibration or a search, estimated from where its algorithm is.

use shared::api::Position;

/// Natural logarithm of the first tempering exponent of a usual calibration, about 1e-5. It rises to 0 over the stages.
const FIRST_LN_EXPONENT: f64 = -11.5;
/// The share of a calibration's work until the exponent is 1.
const CLIMB: f64 = 0.9;
/// The number of evaluations at which 63 % of a search count as done: those of `examples/cmu-sand/all-runs.toml` took 27,000 to 30,000.
/// How many a search takes depends on what it finds, so no time follows from the share.
const SEARCH: f64 = 10_000.0;
/// The number of steps of a usual fit.
const FIT_STEPS: f64 = 8.0;
/// The number of generations of a usual evolution.
const GENERATIONS: f64 = 100.0;
/// The largest share, because the end is not certain.
const MAX_SHARE: f64 = 0.99;

/// Returns the finished share, from 0 to [`MAX_SHARE`].
///
/// # Arguments
/// - `evaluations`: of the whole calibration so far. `step_done`: finished evaluations of the `step_size` of the present step.
pub(super) fn finished_share(position: Position, evaluations: u64, step_done: u64, step_size: u64) -> f64 {
    let settling = |done: f64, usual: f64| 1.0 - (-done / usual).exp();
    let share = match position {
        Position::Fit { steps } => settling(f64::from(steps), FIT_STEPS),
        Position::Evolution { generations } => settling(f64::from(generations), GENERATIONS),
        Position::Search { .. } => settling(evaluations as f64, SEARCH),
        Position::Sampler {
            tempering_exponent, ..
        } if tempering_exponent >= 1.0 => CLIMB + (1.0 - CLIMB) * step_done as f64 / step_size.max(1) as f64,
        Position::Sampler {
            tempering_exponent, ..
        } => CLIMB * (1.0 - tempering_exponent.ln() / FIRST_LN_EXPONENT).clamp(0.0, 1.0),
    };
    share.min(MAX_SHARE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampler(stage: u32, tempering_exponent: f64) -> Position {
        Position::Sampler {
            stage,
            tempering_exponent,
            step: 0,
            acceptance: None,
        }
    }

    #[test]
    fn the_share_of_a_search_moves_until_its_end() {
        // The searches of examples/cmu-sand/all-runs.toml took 27,488, 29,377 and 30,303 evaluations.
        let share = |evaluations| finished_share(Position::Search { rounds: 200 }, evaluations, 0, 1000);
        assert!(share(9_200) < 0.7 && share(30_303) < 0.96);
        assert!(share(30_303) - share(27_488) > 0.01);
    }

    #[test]
    fn every_algorithm_moves_its_share_which_never_reaches_the_whole() {
        let pairs = [
            [sampler(0, 0.0), sampler(1, 1e-4)],
            [sampler(1, 1e-4), sampler(9, 0.5)],
            [sampler(9, 0.5), sampler(12, 1.0)],
            [1, 9].map(|steps| Position::Fit { steps }),
            [1, 9].map(|generations| Position::Evolution { generations }),
            [1, 9].map(|rounds| Position::Search { rounds }),
        ];
        for [early, late] in pairs {
            let [before, after] = [(early, 1000), (late, 9000)].map(|(p, n)| finished_share(p, n, 0, 1000));
            assert!(0.0 <= before && before < after && after < 1.0, "{late:?}");
        }
        assert!(finished_share(sampler(12, 1.0), 0, 90, 100) > finished_share(sampler(12, 1.0), 0, 10, 100));
        let all = finished_share(sampler(12, 1.0), 0, 100, 100);
        assert_eq!(all.to_bits(), MAX_SHARE.to_bits());
    }
}
