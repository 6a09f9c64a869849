//! Wheels whose runs carry each other's names.

use shared::channel::Channel;
use shared::experiment::{Experiment, TestRun};
use shared::limit::number;

use super::contradiction::{Cause, Contradiction};
use super::like_runs::{have_like_loads, share_soil};
use super::question::{EXCHANGED_WHEELS, Question};

/// Minimum number of pairs of runs that are compared.
const MIN_PAIRS: usize = 3;
/// Slip above which grousers certainly add to the pull.
const PULLING: f64 = 0.2;
/// Largest difference of like slips.
const LIKE_SLIPS: f64 = 0.05;
/// Slip angle up to which the wheels roll rather than slide sideways `[deg]`.
const ROLLING_DEG: f64 = 45.0;
/// Relative difference up to which rims count as equal.
const LIKE_RIMS: f64 = 0.02;
/// Share of the load by which the smooth wheel pulls more, on average, before that is odd.
const MIN_EXCESS: f64 = 0.02;

/// Returns the question about two wheels that seem exchanged: by the balance of moments for wheels of different radii, by the pull for
/// wheels that differ by their grousers.
///
/// Checked by `tests` below and `farm-tests mistaken_tables::every_mistake_of_a_table_is_asked_about`.
pub(super) fn question(experiment: &Experiment, found: Option<&Contradiction>) -> Option<Question> {
    let by_moments = found.and_then(|found| match &found.cause {
        Cause::ExchangedWheels([first, second]) => Some(format!(
            "{} wheels {first} and {second} are exchanged: do the runs of each carry the name of the other?",
            found.words()
        )),
        _ => None,
    });
    let words = by_moments.or_else(|| smooth_wheel_that_pulls_more(experiment))?;
    Some(Question::new(EXCHANGED_WHEELS, words))
}

/// Returns the complaint about a wheel that pulls more in all like runs than the same rim with higher grousers.
fn smooth_wheel_that_pulls_more(experiment: &Experiment) -> Option<String> {
    let names = || experiment.wheels.keys().map(String::as_str);
    names().find_map(|high| {
        let low = names().filter(|low| has_higher_grousers(experiment, high, low));
        low.into_iter().find_map(|low| more_pull(experiment, high, low))
    })
}

fn has_higher_grousers(experiment: &Experiment, high: &str, low: &str) -> bool {
    let [high, low] = [high, low].map(|wheel| &experiment.wheels[wheel]);
    let is_like = |high: f64, low: f64| (high - low).abs() <= LIKE_RIMS * low;
    is_like(high.radius_m, low.radius_m)
        && is_like(high.width_m, low.width_m)
        && high.grouser_height_m > low.grouser_height_m + LIKE_RIMS * low.radius_m
}

/// Returns the complaint about the wheel with the lower grousers, if it pulls more in all like runs.
fn more_pull(experiment: &Experiment, high: &str, low: &str) -> Option<String> {
    let pulls = |wheel: &str| -> Vec<(&TestRun, f64)> {
        let runs = experiment.runs.iter().filter(|run| {
            run.wheel == wheel && run.slip >= PULLING && run.slip_angle_deg.abs() <= ROLLING_DEG
        });
        runs.filter_map(|run| Some((run, run.measured[Channel::DrawbarPull.index()]?)))
            .collect()
    };
    let low_pulls = pulls(low);
    let (mut count, mut sum, mut largest) = (0_usize, 0.0, None);
    for (high_run, high_n) in pulls(high) {
        for &(low_run, low_n) in &low_pulls {
            let are_like = share_soil(high_run, low_run)
                && have_like_loads(high_run, low_run)
                && (high_run.slip - low_run.slip).abs() <= LIKE_SLIPS;
            if !are_like {
                continue;
            }
            let excess_n = low_n - high_n;
            if excess_n <= 0.0 {
                return None;
            }
            count += 1;
            sum += excess_n / low_run.wheel_load_n;
            if largest.is_none_or(|(_, _, _, _, largest_n)| excess_n > largest_n) {
                largest = Some((low_run, low_n, high_run, high_n, excess_n));
            }
        }
    }
    let (low_run, low_n, high_run, high_n, _) = largest?;
    (count >= MIN_PAIRS && sum >= MIN_EXCESS * count as f64).then(|| {
        format!(
            "wheel {low} pulls more than wheel {high}, the same rim with higher grousers, in all {count} pairs of like runs from slip {PULLING} on, as in run {}: {} N, and run {}: {} N: do the runs of each wheel carry the name of the other?",
            low_run.name,
            number(low_n),
            high_run.name,
            number(high_n)
        )
    })
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    /// Returns the words of the question about a smooth and a grousered wheel with these pulls at four slips.
    fn words(smooth_n: [f64; 4], grousered_n: [f64; 4]) -> Option<String> {
        let mut runs = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n".to_owned();
        for (wheel, pulls) in [("smooth", smooth_n), ("grousered", grousered_n)] {
            for (place, pull) in pulls.into_iter().enumerate() {
                let slip = 0.2 * place as f64;
                runs += &format!("{wheel}{place},{wheel},s,{slip},60,0.01,{pull},fit\n");
            }
        }
        let rim = "radius_m = 0.1\nwidth_m = 0.1\n";
        let toml = format!(
            "runs = \"runs.csv\"\n[wheel.smooth]\n{rim}[wheel.grousered]\n{rim}grouser_count = 12\ngrouser_height_m = 0.01\ngrouser_thickness_m = 0.002\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n"
        );
        let files = [("runs.csv".to_owned(), runs)].into();
        let experiment = Experiment::parse("experiment.toml", &FileSet { toml, files }).unwrap();
        question(&experiment, None).map(|question| question.words)
    }

    #[test]
    fn a_smooth_wheel_that_pulls_more_in_all_like_runs_is_asked_about() {
        let (less, more) = ([-6.0, 5.0, 9.0, 8.0], [-6.0, 9.0, 14.0, 16.0]);
        assert_eq!(words(less, more), None);
        assert_eq!(
            words(more, less).unwrap(),
            "wheel smooth pulls more than wheel grousered, the same rim with higher grousers, in all 3 pairs of like runs from slip 0.2 on, as in run smooth3: 16 N, and run grousered3: 8 N: do the runs of each wheel carry the name of the other?"
        );
        // One pair in which the grousers help, or a difference within the noise, is no evidence.
        assert_eq!(words(more, [-6.0, 9.5, 9.0, 8.0]), None);
        assert_eq!(words(less.map(|pull| pull + 0.5), less), None);
    }
}
