//! Channels whose zero is not where it should be.

use shared::channel::Channel;
use shared::experiment::{Experiment, TestRun};
use shared::limit::number;

use super::contradiction::{Cause, Contradiction};
use super::like_runs::share_wheel_and_soil;
use super::question::{FORCE_ZERO, Question, SINKAGE_ZERO};

/// Minimum number of runs, and of pairs of runs, that determine a zero.
const MIN_RUNS: usize = 3;
/// Skid beyond which the soil certainly holds a wheel back.
const BRAKED: f64 = -0.2;
/// Slip angle above which a wheel is dragged sideways rather than rolled `[deg]`.
const ROLLING_DEG: f64 = 45.0;
/// Depth above the undisturbed surface at which no loaded wheel rolls, in shares of the radius.
const ABOVE_SURFACE: f64 = 0.02;
/// Smallest ratio of loads, largest difference of slips and largest ratio of speeds of runs that differ by their load.
const OTHER_LOAD: f64 = 1.3;
const LIKE_SLIPS: f64 = 0.03;
const LIKE_SPEEDS: f64 = 1.1;
/// Exponent of the sinkage over the wheel load below which it hardly grows, and in usual soils: 2 / (2 n + 1) of the sinkage exponent
/// n is from .4 to .8.
const FLAT_EXPONENT: f64 = 0.25;
const USUAL_EXPONENT: f64 = 0.6;
/// Smallest offset of the sinkage that is asked about, in shares of the radius: rigs are zeroed better than that.
const MIN_SINKAGE_OFFSET: f64 = 0.05;
/// Steps of the bisection for the offset of the sinkage, which leave a millionth of the smallest sinkage.
const BISECTIONS: usize = 20;

/// Returns the questions about the zero of pull or torque, and of the sinkage.
///
/// Checked by `tests` below and `farm-tests mistaken_tables::every_mistake_of_a_table_is_asked_about`.
pub(super) fn questions(experiment: &Experiment, found: Option<&Contradiction>) -> Vec<Question> {
    let force = found
        .and_then(force_by_moments)
        .or_else(|| braked_pull(experiment));
    let sinkage = above_surface(experiment).or_else(|| flat_sinkage(experiment));
    let force = force.map(|words| Question::new(FORCE_ZERO, words));
    let sinkage = sinkage.map(|words| Question::new(SINKAGE_ZERO, words));
    force.into_iter().chain(sinkage).collect()
}

fn force_by_moments(found: &Contradiction) -> Option<String> {
    let Cause::ForceZero { pull_n, torque_n_m } = found.cause else {
        return None;
    };
    let [pull, torque] = match pull_n > 0.0 {
        true => ["lower", "higher"],
        false => ["higher", "lower"],
    };
    let rounded = |size: f64| number((1e2 * size.abs()).round() / 1e2);
    Some(format!(
        "{} drawbar_pull_n is {} N {pull}, or torque_n_m {} N m {torque}, in every run: was a sensor not zeroed? Subtract its reading without load",
        found.words(),
        rounded(pull_n),
        rounded(torque_n_m)
    ))
}

/// Returns the complaint about a wheel that pulls in every run, though the sled drags it in some.
fn braked_pull(experiment: &Experiment) -> Option<String> {
    let runs = experiment
        .runs
        .iter()
        .filter(|run| run.slip_angle_deg.abs() <= ROLLING_DEG);
    let pulls = runs.filter_map(|run| Some((run, run.measured[Channel::DrawbarPull.index()]?)));
    let pulls: Vec<(&TestRun, f64)> = pulls.collect();
    let braked: Vec<&(&TestRun, f64)> = pulls.iter().filter(|(run, _)| run.slip <= BRAKED).collect();
    let least = braked.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let is_positive = pulls.iter().all(|(_, pull_n)| *pull_n > 0.0);
    let is_driven = pulls.iter().any(|(run, _)| run.slip >= -BRAKED);
    (is_positive && is_driven && braked.len() >= MIN_RUNS).then(|| {
        format!(
            "drawbar_pull_n is positive in every run, also in {} at a slip of {BRAKED} or less, in which the sled drags the wheel, as in run {}: {} N at slip {}: was the sensor not zeroed? Subtract its reading without load",
            braked.len(),
            least.0.name,
            number(least.1),
            number(least.0.slip)
        )
    })
}

/// Returns the complaint about a wheel that rolls above the undisturbed surface in some runs.
fn above_surface(experiment: &Experiment) -> Option<String> {
    let sinkages = experiment.runs.iter().filter_map(|run| {
        let sinkage_m = run.measured[Channel::Sinkage.index()]?;
        Some((run, sinkage_m, sinkage_m / experiment.wheels[&run.wheel].radius_m))
    });
    let sinkages: Vec<(&TestRun, f64, f64)> = sinkages.collect();
    let (run, sinkage_m, size) = sinkages.iter().min_by(|a, b| a.2.total_cmp(&b.2))?;
    let is_mixed = sinkages.iter().any(|(_, sinkage_m, _)| *sinkage_m > 0.0);
    (is_mixed && *size < -ABOVE_SURFACE).then(|| {
        format!(
            "sinkage_m {} m of run {} lies above the undisturbed surface, on which a loaded wheel cannot stand: does sinkage_m count from another zero?",
            number(*sinkage_m),
            run.name
        )
    })
}

/// Returns the complaint about a sinkage that hardly grows with the wheel load.
fn flat_sinkage(experiment: &Experiment) -> Option<String> {
    let pairs = load_pairs(experiment);
    let smallest_m = pairs
        .iter()
        .map(|pair| pair.less_m.min(pair.more_m))
        .reduce(f64::min)?;
    let exponent = median_exponent(&pairs, 0.0);
    if pairs.len() < MIN_RUNS || smallest_m <= 0.0 || exponent >= FLAT_EXPONENT {
        return None;
    }
    // The exponent grows with the offset that is subtracted, without bound at the smallest sinkage.
    let [mut low, mut high] = [0.0, smallest_m];
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        match median_exponent(&pairs, middle) < USUAL_EXPONENT {
            true => low = middle,
            false => high = middle,
        }
    }
    let radius_m = pairs.iter().map(|pair| pair.radius_m).fold(0.0, f64::max);
    (low >= MIN_SINKAGE_OFFSET * radius_m).then(|| {
        format!(
            "sinkage_m hardly grows with wheel_load_n: by load to the power of {} in {} pairs of runs that differ by their load, where {FLAT_EXPONENT} is little and {USUAL_EXPONENT} usual, as if every sinkage was {} m too large: does sinkage_m count from another zero?",
            number((1e2 * exponent).round() / 1e2),
            pairs.len(),
            number((1e3 * low).round() / 1e3)
        )
    })
}

/// The sinkages of two runs that differ by their load.
struct LoadPair {
    less_m: f64,
    more_m: f64,
    load_ratio: f64,
    radius_m: f64,
}

fn load_pairs(experiment: &Experiment) -> Vec<LoadPair> {
    let sinkage = |run: &TestRun| run.measured[Channel::Sinkage.index()];
    let runs = experiment
        .runs
        .iter()
        .filter_map(|run| Some((run, sinkage(run)?)));
    let runs: Vec<(&TestRun, f64)> = runs.collect();
    let mut pairs = Vec::new();
    for &(less, less_m) in &runs {
        let heavier = runs
            .iter()
            .filter(|(more, _)| more.wheel_load_n >= OTHER_LOAD * less.wheel_load_n);
        for &(more, more_m) in heavier {
            let speed_ratio = more.sled_speed_m_s / less.sled_speed_m_s;
            let differs_by_load = share_wheel_and_soil(less, more)
                && (more.slip - less.slip).abs() <= LIKE_SLIPS
                && (1.0 / LIKE_SPEEDS..=LIKE_SPEEDS).contains(&speed_ratio);
            if differs_by_load {
                pairs.push(LoadPair {
                    less_m,
                    more_m,
                    load_ratio: more.wheel_load_n / less.wheel_load_n,
                    radius_m: experiment.wheels[&less.wheel].radius_m,
                });
            }
        }
    }
    pairs
}

/// Returns the median exponent of the sinkage over the load, after an offset is subtracted from every sinkage.
fn median_exponent(pairs: &[LoadPair], offset_m: f64) -> f64 {
    let exponents = pairs.iter().map(|pair| {
        let ratio = (pair.more_m - offset_m) / (pair.less_m - offset_m);
        libm::log(ratio) / libm::log(pair.load_ratio)
    });
    let mut exponents: Vec<f64> = exponents.collect();
    exponents.sort_by(f64::total_cmp);
    exponents[exponents.len() / 2]
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    /// Returns the names of the questions about runs of slip, wheel load, pull and sinkage.
    fn raised(rows: &[[f64; 4]]) -> Vec<String> {
        let mut runs =
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,sinkage_m,use\n".to_owned();
        for (place, [slip, load, pull, sinkage]) in rows.iter().enumerate() {
            runs += &format!("r{place},w,s,{slip},{load},0.01,{pull},{sinkage},fit\n");
        }
        let toml = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.1\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\nsinkage_m = 0.001\n";
        let files = [("runs.csv".to_owned(), runs)].into();
        let experiment = FileSet {
            toml: toml.into(),
            files,
        };
        let experiment = Experiment::parse("experiment.toml", &experiment).unwrap();
        let questions = questions(&experiment, None).into_iter();
        questions.map(|question| question.name).collect()
    }

    /// A wheel under two loads that sinks by the load to the power of .6.
    fn right() -> Vec<[f64; 4]> {
        let runs = [-0.5, -0.3, -0.2, 0.0, 0.2, 0.4].into_iter().flat_map(|slip| {
            [(60.0, 0.006), (120.0, 0.0091)]
                .map(|(load, sinkage)| [slip, load, 0.3 * slip * load - 3.0, sinkage + 0.005 * slip * slip])
        });
        runs.collect()
    }

    fn plus(pull_n: f64, sinkage_m: f64) -> Vec<[f64; 4]> {
        let shifted =
            |[slip, load, pull, sinkage]: [f64; 4]| [slip, load, pull + pull_n, sinkage + sinkage_m];
        right().into_iter().map(shifted).collect()
    }

    #[test]
    fn a_zero_that_the_data_can_determine_is_asked_about() {
        let none: [&str; 0] = [];
        assert_eq!(raised(&right()), none);
        assert_eq!(raised(&plus(25.0, 0.0)), ["force_zero"]);
        assert_eq!(raised(&plus(0.0, 0.012)), ["sinkage_zero"]);
        assert_eq!(raised(&plus(0.0, -0.009)), ["sinkage_zero"]);
    }

    #[test]
    fn a_zero_that_the_data_cannot_determine_is_not() {
        let none: [&str; 0] = [];
        assert_eq!(raised(&plus(10.0, 0.003)), none);
        // A wheel under one load may sink deep, and one that is never braked may always pull.
        let one_load = |rows: Vec<[f64; 4]>| -> Vec<[f64; 4]> {
            rows.into_iter().filter(|[_, load, ..]| *load < 61.0).collect()
        };
        assert_eq!(raised(&one_load(plus(0.0, 0.02))), none);
        assert_eq!(raised(&plus(25.0, 0.0)[6..]), none);
    }
}
