//! Columns that hold each other's quantities.

use shared::channel::Channel;
use shared::experiment::{Experiment, TestRun};
use shared::limit::number;

use super::contradiction::{Cause, Contradiction};
use super::question::{Question, SWAPPED_COLUMNS};
use super::sign::expected_sign;

/// Minimum number of runs, and of pairs of runs, that are judged.
const MIN_RUNS: usize = 3;
/// Pull over load beyond which hardly any wheel pulls.
const MAX_PULL: f64 = 1.2;
/// Relative difference of loads at one level, and of pulls.
const ONE_LOAD: f64 = 0.15;
/// The same of speeds, which rigs control more precisely.
const ONE_SPEED: f64 = 0.02;
/// Slip that a series with different slips exceeds.
const MIN_LARGEST_SLIP: f64 = 0.1;
/// Speed of the sled that few rigs reach `[m/s]`.
const FAST_M_S: f64 = 0.2;
/// Factor by which a swap must reduce the number of wrong signs.
const FEWER_SIGNS: usize = 5;

/// Returns the question about two columns that seem swapped.
///
/// Checked by `tests` below and `farm-tests mistaken_tables::every_mistake_of_a_table_is_asked_about`.
pub(super) fn question(experiment: &Experiment, found: Option<&Contradiction>) -> Option<Question> {
    let by_moments = found
        .filter(|found| found.cause == Cause::SwappedColumns)
        .map(|found| format!("{} drawbar_pull_n and torque_n_m are swapped", found.words()));
    let found = by_moments
        .or_else(|| pull_and_load(experiment))
        .or_else(|| pull_and_lateral_force(experiment))
        .or_else(|| slip_and_speed(experiment))?;
    let words = format!("{found}: does each of the two columns hold the other's values?");
    Some(Question::new(SWAPPED_COLUMNS, words))
}

/// Returns the complaint about pulls beyond the loads in most runs, at fewer levels than the loads, as rigs set loads.
fn pull_and_load(experiment: &Experiment) -> Option<String> {
    let pulls = experiment
        .runs
        .iter()
        .filter_map(|run| Some((run, run.measured[Channel::DrawbarPull.index()]?)));
    let pulls: Vec<(&TestRun, f64)> = pulls.collect();
    let beyond = pulls
        .iter()
        .filter(|(run, pull_n)| *pull_n > MAX_PULL * run.wheel_load_n);
    let beyond: Vec<&(&TestRun, f64)> = beyond.collect();
    let (run, pull_n) = beyond.first()?;
    let is_positive = pulls.iter().all(|(_, pull_n)| *pull_n > 0.0);
    let pull_levels = levels(ONE_LOAD, pulls.iter().map(|(_, pull_n)| *pull_n));
    let load_levels = levels(ONE_LOAD, pulls.iter().map(|(run, _)| run.wheel_load_n));
    let is_odd = beyond.len() >= MIN_RUNS
        && 2 * beyond.len() > pulls.len()
        && is_positive
        && pull_levels < load_levels;
    is_odd.then(|| {
        format!(
            "drawbar_pull_n is over {MAX_PULL} times wheel_load_n in {} of {} runs, as in run {}: {} N and {} N, and has {pull_levels} levels where wheel_load_n has {load_levels}",
            beyond.len(),
            pulls.len(),
            run.name,
            number(*pull_n),
            number(run.wheel_load_n)
        )
    })
}

/// Returns the number of levels of positive values: a value starts a level if it is larger than the first of the level below by more
/// than a relative difference.
fn levels(difference: f64, values: impl Iterator<Item = f64>) -> usize {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let (mut count, mut end) = (0, f64::NEG_INFINITY);
    for value in values {
        if value > end {
            count += 1;
            end = value * (1.0 + difference);
        }
    }
    count
}

/// Returns the complaint about signs of pull and lateral force that are wrong in many runs and right in nearly all if the two columns
/// are swapped.
fn pull_and_lateral_force(experiment: &Experiment) -> Option<String> {
    let channels = [Channel::DrawbarPull, Channel::LateralForce];
    let measured = |run: &&TestRun| channels.iter().all(|c| run.measured[c.index()].is_some());
    let runs: Vec<&TestRun> = experiment.runs.iter().filter(measured).collect();
    // A value of 0 has no sign, so that a column without forces is not taken for one with the right signs.
    let is_wrong = |run: &TestRun, channel: Channel, column: Channel| {
        Some(run.measured[column.index()]? * expected_sign(run, channel)? <= 0.0)
    };
    let signs = |channel: Channel, column: Channel| -> Vec<bool> {
        runs.iter()
            .filter_map(|run| is_wrong(run, channel, column))
            .collect()
    };
    let wrong = |signs: &[bool]| signs.iter().filter(|is_wrong| **is_wrong).count();
    let [pull, lateral] = channels;
    let stated = [signs(pull, pull), signs(lateral, lateral)];
    let swapped = wrong(&signs(pull, lateral)) + wrong(&signs(lateral, pull));
    let judged = stated[0].len() + stated[1].len();
    let stated = stated.map(|signs| wrong(&signs));
    // A wrong sign of one column alone is another question, and a few of each may be noise about zero.
    let is_odd = stated.iter().all(|count| *count >= MIN_RUNS);
    let stated = stated[0] + stated[1];
    (is_odd && 5 * stated >= judged && stated >= FEWER_SIGNS * swapped).then(|| {
        format!(
            "drawbar_pull_n and lateral_force_n have the wrong sign in {stated} of {judged} measurements whose sign slip and slip angle determine, and in {swapped} if they are swapped"
        )
    })
}

/// Returns the complaint about slips that are all small beside fast sleds, where sled or rim have fewer speeds if the two are swapped:
/// rigs hold one of these speeds while they set the slip.
fn slip_and_speed(experiment: &Experiment) -> Option<String> {
    let columns: Vec<[f64; 2]> = experiment
        .runs
        .iter()
        .map(|run| [run.slip, run.sled_speed_m_s])
        .collect();
    let largest_slip = columns.iter().map(|[slip, _]| slip.abs()).reduce(f64::max)?;
    let fastest_m_s = columns.iter().map(|[_, speed]| *speed).reduce(f64::max)?;
    let can_be_swapped = columns.iter().all(|[slip, speed]| *slip > 0.0 && *speed < 1.0);
    if columns.len() < MIN_RUNS
        || !can_be_swapped
        || largest_slip > MIN_LARGEST_SLIP
        || fastest_m_s < FAST_M_S
    {
        return None;
    }
    let speeds = |columns: &[[f64; 2]]| {
        let sled = levels(ONE_SPEED, columns.iter().map(|[_, speed]| *speed));
        let rim = levels(
            ONE_SPEED,
            columns.iter().map(|[slip, speed]| speed / (1.0 - slip)),
        );
        sled.min(rim)
    };
    let swapped: Vec<[f64; 2]> = columns.iter().map(|[slip, speed]| [*speed, *slip]).collect();
    let [stated, swapped] = [speeds(&columns), speeds(&swapped)];
    (swapped < stated).then(|| {
        format!(
            "slip is at most {} in all {} runs beside a sled_speed_m_s of up to {} m/s, and sled and rim have {stated} different speeds or more, and {swapped} if slip and sled_speed_m_s are swapped",
            number(largest_slip),
            columns.len(),
            number(fastest_m_s)
        )
    })
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    /// Returns whether columns of slip, wheel load, sled speed, slip angle, pull and lateral force seem swapped.
    fn is_asked(rows: &[[f64; 6]]) -> bool {
        let mut runs =
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,drawbar_pull_n,lateral_force_n,use\n".to_owned();
        for (place, [slip, load, speed, angle, pull, lateral]) in rows.iter().enumerate() {
            runs += &format!("r{place},w,s,{slip},{load},{speed},{angle},{pull},{lateral},fit\n");
        }
        let toml = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.1\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\nlateral_force_n = 1.0\n";
        let files = [("runs.csv".to_owned(), runs)].into();
        let experiment = FileSet {
            toml: toml.into(),
            files,
        };
        let experiment = Experiment::parse("experiment.toml", &experiment).unwrap();
        question(&experiment, None).is_some()
    }

    /// A wheel at a slip angle of 15 degrees, driven and then braked.
    const RIGHT: [[f64; 6]; 6] = [
        [0.1, 60.0, 0.01, 15.0, 3.0, 12.0],
        [0.3, 60.0, 0.01, 15.0, 12.0, 9.0],
        [0.6, 60.0, 0.01, 15.0, 20.0, 6.0],
        [-0.2, 60.0, 0.01, 15.0, -20.0, 15.0],
        [-0.4, 60.0, 0.01, 15.0, -30.0, 16.0],
        [-0.6, 60.0, 0.01, 15.0, -38.0, 17.0],
    ];

    fn swap(rows: &[[f64; 6]], a: usize, b: usize) -> Vec<[f64; 6]> {
        let swapped = |row: &[f64; 6]| {
            let mut row = *row;
            row.swap(a, b);
            row
        };
        rows.iter().map(swapped).collect()
    }

    #[test]
    fn two_swapped_columns_are_asked_about() {
        assert!(!is_asked(&RIGHT));
        assert!(is_asked(&swap(&RIGHT, 4, 5)), "pull and lateral force");
        assert!(!is_asked(&RIGHT[..3]));
        assert!(is_asked(&swap(&RIGHT[..3], 1, 4)), "load and pull");
        assert!(is_asked(&swap(&RIGHT[..3], 0, 2)), "slip and speed");
    }

    #[test]
    fn pulls_in_another_unit_are_no_swap() {
        let in_grams = RIGHT.map(|[slip, load, speed, angle, pull, lateral]| {
            [slip, load, speed, angle, 100.0 * pull, 100.0 * lateral]
        });
        assert!(!is_asked(&in_grams[..3]));
    }
}
