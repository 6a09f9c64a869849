//! Channels that were measured with the opposite sign.
//!
//! In runs in which the wheel certainly drives or brakes, the sign of a channel is known. A channel that has the other sign in all
//! these runs was probably recorded in the rig's axes, and a search would explain it by an effect with the same sign, as bulldozing
//! on the pull.

use shared::channel::Channel;
use shared::experiment::{Experiment, TestRun};
use shared::limit::number;

use super::like_runs::differ_in_slip;
use super::question::{Question, sign_name};

/// Minimum number of runs, and of pairs of runs, that determine a sign.
const MIN_RUNS: usize = 3;
/// Slip above which thrust exceeds resistance: below it, a driven wheel on soft soil may still be pushed.
const PULLING: f64 = 0.2;
/// Slip above which the torque exceeds the friction of bearings, and wheels usually pull.
const TURNING: f64 = 0.1;
/// Slip up to which the pull grows with slip; above it, a wheel that digs may pull less.
const RISING: f64 = 0.3;
/// Smallest difference of two distinct slips.
const APART: f64 = 0.05;
/// Slip angle above which a wheel is dragged sideways rather than rolled `[deg]`.
const ROLLING_DEG: f64 = 45.0;
/// Slip angle above which the soil certainly resists sideways motion `[deg]`.
const SIDEWAYS_DEG: f64 = 5.0;

/// Returns the questions about the signs of all channels.
///
/// Checked by `tests` below, `farm-tests bad_input::gallery::no_mistake_of_a_user_is_silent` and, for no question where none is due, by
/// `farm-tests mistakes::the_examples_raise_no_question`.
pub(super) fn questions(experiment: &Experiment) -> impl Iterator<Item = Question> {
    let of_channel = |channel: Channel| {
        let complaint = match channel {
            Channel::DrawbarPull => opposite(experiment, channel).or_else(|| falling_pull(experiment)),
            _ => opposite(experiment, channel),
        };
        complaint.map(|found| {
            let (column, name) = (channel.column(), channel.name());
            let words = format!(
                "{found}, but {}: turn the sign of {column}, in the map of an import by formula = \"-{name}\" with the rig's column under [quantities.{name}]",
                convention(channel)
            );
            Question::new(sign_name(channel), words)
        })
    };
    Channel::ALL.into_iter().filter_map(of_channel)
}

fn convention(channel: Channel) -> &'static str {
    match channel {
        Channel::DrawbarPull => {
            "it is positive where the wheel pulls the sled, and slip is positive where the wheel drives"
        }
        Channel::Torque => "it is positive where the motor drives the wheel, as slip is",
        Channel::Sinkage => "it is positive below the undisturbed surface",
        Channel::LateralForce => {
            "it is positive where the soil resists the sideways motion of a positive slip angle"
        }
    }
}

/// Returns a description of the runs in which the sign of a channel is known.
fn known_where(channel: Channel) -> String {
    match channel {
        Channel::DrawbarPull => format!(" at a slip of {PULLING} or more either way"),
        Channel::Torque => format!(" at a slip of {TURNING} or more either way"),
        Channel::Sinkage => String::new(),
        Channel::LateralForce => format!(" at a slip angle of {SIDEWAYS_DEG} degrees or more either way"),
    }
}

/// Returns the sign of a channel in a run: 1 or -1; `None` if both are possible.
pub(super) fn expected_sign(run: &TestRun, channel: Channel) -> Option<f64> {
    let rolls = run.slip_angle_deg.abs() <= ROLLING_DEG;
    let (is_known, quantity) = match channel {
        Channel::DrawbarPull => (rolls && run.slip.abs() >= PULLING, run.slip),
        Channel::Torque => (rolls && run.slip.abs() >= TURNING, run.slip),
        Channel::Sinkage => (true, 1.0),
        Channel::LateralForce => (run.slip_angle_deg.abs() >= SIDEWAYS_DEG, run.slip_angle_deg),
    };
    is_known.then(|| quantity.signum())
}

/// Returns the complaint about a channel that has the opposite sign, or is 0, in every run in which its sign is known.
fn opposite(experiment: &Experiment, channel: Channel) -> Option<String> {
    let judged = experiment.runs.iter().filter_map(|run| {
        let value = run.measured[channel.index()]?;
        Some((run, value, value * expected_sign(run, channel)?))
    });
    let judged: Vec<(&TestRun, f64, f64)> = judged.collect();
    let is_right = |(_, _, signed): &(&TestRun, f64, f64)| *signed > 0.0;
    // A channel that is 0 everywhere has no sign.
    let (run, value, _) = judged.iter().find(|(_, _, signed)| *signed < 0.0)?;
    if judged.len() < MIN_RUNS || judged.iter().any(is_right) {
        return None;
    }
    let quantity = match channel {
        Channel::LateralForce => format!(" at a slip angle of {} degrees", number(run.slip_angle_deg)),
        Channel::Sinkage => String::new(),
        _ => format!(" at slip {}", number(run.slip)),
    };
    Some(format!(
        "{} has the opposite sign in all {} runs{}, as in run {}: {} {}{quantity}",
        channel.column(),
        judged.len(),
        known_where(channel),
        run.name,
        number(*value),
        channel.unit(),
    ))
}

/// What is odd about a pull that is negative in most driven runs and falls with slip between all runs that are alike but for slip: some
/// pull of a wheel that is held back has the sign that the others should have.
fn falling_pull(experiment: &Experiment) -> Option<String> {
    let pull = |run: &TestRun| run.measured[Channel::DrawbarPull.index()];
    let measured = experiment.runs.iter().filter_map(|run| Some((run, pull(run)?)));
    let measured: Vec<(&TestRun, f64)> = measured
        .filter(|(run, _)| run.slip_angle_deg.abs() <= ROLLING_DEG)
        .collect();
    let moved = measured.iter().filter(|(run, _)| run.slip.abs() >= TURNING);
    let signs: Vec<bool> = moved.map(|(run, pull)| pull * run.slip < 0.0).collect();
    if 2 * signs.iter().filter(|is_opposite| **is_opposite).count() <= signs.len() {
        return None;
    }
    let rising = measured.iter().filter(|(run, _)| run.slip.abs() <= RISING);
    let rising: Vec<&(&TestRun, f64)> = rising.collect();
    let (mut pairs, mut steepest): (usize, Option<[&(&TestRun, f64); 2]>) = (0, None);
    let fall = |[low, high]: [&(&TestRun, f64); 2]| low.1 - high.1;
    for low in &rising {
        for high in rising.iter().filter(|high| high.0.slip - low.0.slip > APART) {
            if !differ_in_slip(low.0, high.0) {
                continue;
            }
            if high.1 >= low.1 {
                return None;
            }
            pairs += 1;
            if steepest.is_none_or(|pair| fall([low, high]) > fall(pair)) {
                steepest = Some([low, high]);
            }
        }
    }
    let [low, high] = steepest.filter(|_| pairs >= MIN_RUNS)?;
    Some(format!(
        "drawbar_pull_n falls with slip between all {pairs} pairs of like runs up to slip {RISING}, as from run {} to run {}: {} N at slip {}, {} N at slip {}",
        low.0.name,
        high.0.name,
        number(low.1),
        number(low.0.slip),
        number(high.1),
        number(high.0.slip),
    ))
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    /// Returns the names of the questions about runs of slip, wheel load, slip angle, pull, torque, sinkage and lateral force.
    fn asked(rows: &[[f64; 7]]) -> Vec<String> {
        let mut runs = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,drawbar_pull_n,torque_n_m,sinkage_m,lateral_force_n,use\n".to_owned();
        for (i, [slip, load, angle, channels @ ..]) in rows.iter().enumerate() {
            let channels = channels.map(|value| match value.is_nan() {
                true => String::new(),
                false => value.to_string(),
            });
            runs += &format!("r{i},w,s,{slip},{load},0.01,{angle},{},fit\n", channels.join(","));
        }
        let experiment = FileSet {
            toml: "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.1\n[soil.s]\n[noise]\n\
                   drawbar_pull_n = 1.0\ntorque_n_m = 0.1\nsinkage_m = 0.001\nlateral_force_n = 1.0\n"
                .into(),
            files: [("runs.csv".to_owned(), runs)].into(),
        };
        let experiment = Experiment::parse("experiment.toml", &experiment).unwrap();
        questions(&experiment).map(|question| question.name).collect()
    }

    const BLANK: f64 = f64::NAN;
    /// A wheel that is held back at a small slip, and pulls beyond it.
    const RIGHT: [[f64; 7]; 5] = [
        [0.05, 60.0, 0.0, -6.0, 0.4, 0.004, 0.0],
        [0.1, 60.0, 0.0, -1.0, 1.2, 0.005, 0.0],
        [0.2, 60.0, 0.0, 5.0, 2.0, 0.006, 0.0],
        [0.4, 60.0, 0.0, 9.0, 2.6, 0.008, 0.0],
        [0.6, 60.0, 0.0, 8.0, 2.8, 0.012, 0.0],
    ];

    fn times(rows: &[[f64; 7]], signs: [f64; 4]) -> Vec<[f64; 7]> {
        let one = |row: &[f64; 7]| {
            let [slip, load, angle, pull, torque, sinkage, side] = *row;
            let [p, t, z, y] = signs;
            [slip, load, angle, p * pull, t * torque, z * sinkage, y * side]
        };
        rows.iter().map(one).collect()
    }

    #[test]
    fn each_channel_with_the_other_sign_is_asked_about_by_itself() {
        let none: [&str; 0] = [];
        assert_eq!(asked(&RIGHT), none);
        assert_eq!(
            asked(&times(&RIGHT, [-1.0, 1.0, 1.0, 1.0])),
            ["drawbar_pull_sign"]
        );
        assert_eq!(asked(&times(&RIGHT, [1.0, -1.0, 1.0, 1.0])), ["torque_sign"]);
        assert_eq!(asked(&times(&RIGHT, [1.0, 1.0, -1.0, 1.0])), ["sinkage_sign"]);
        let all = times(&RIGHT, [-1.0; 4]);
        assert_eq!(asked(&all), ["drawbar_pull_sign", "torque_sign", "sinkage_sign"]);
        // The pull is told without a torque, too.
        assert_eq!(
            asked(&times(&RIGHT, [-1.0, BLANK, 1.0, 1.0])),
            ["drawbar_pull_sign"]
        );
    }

    #[test]
    fn a_wheel_that_is_held_back_at_small_slip_is_not_asked_about() {
        let none: [&str; 0] = [];
        assert_eq!(asked(&RIGHT[..2]), none);
        // Two runs tell no sign, nor does a channel that is 0.
        assert_eq!(asked(&times(&RIGHT[3..], [-1.0, 1.0, 1.0, 1.0])), none);
        assert_eq!(asked(&times(&RIGHT, [0.0, 0.0, 0.0, 0.0])), none);
        // A wheel may dig in and pull less.
        let digging = [0.2, 0.3, 0.4, 0.6].map(|slip| [slip, 60.0, 0.0, 12.0 - 25.0 * slip, 2.0, 0.01, 0.0]);
        assert_eq!(asked(&digging), none);
    }

    #[test]
    fn a_pull_that_falls_with_slip_is_asked_about_though_a_heavy_wheel_is_held_back() {
        // Under 200 N the wheel is held back at every slip.
        let heavy = RIGHT.map(|[slip, _, angle, pull, torque, sinkage, side]| {
            [slip, 200.0, angle, pull - 12.0, 3.0 * torque, 2.0 * sinkage, side]
        });
        let campaign = [&RIGHT[..], &RIGHT[..], &heavy[..1]].concat();
        let mixed = [&campaign[..], &heavy[3..4]].concat();
        let none: [&str; 0] = [];
        assert_eq!(asked(&mixed), none);
        assert_eq!(
            asked(&times(&mixed, [-1.0, 1.0, 1.0, 1.0])),
            ["drawbar_pull_sign"]
        );
    }

    #[test]
    fn a_braked_wheel_and_a_wheel_at_an_angle_have_signs_of_their_own() {
        let braked = [-0.2, -0.4, -0.7].map(|slip| [slip, 60.0, 20.0, 30.0 * slip, slip, 0.02, 8.0]);
        let none: [&str; 0] = [];
        assert_eq!(asked(&braked), none);
        assert_eq!(
            asked(&times(&braked, [-1.0, 1.0, 1.0, 1.0])),
            ["drawbar_pull_sign"]
        );
        assert_eq!(
            asked(&times(&braked, [1.0, 1.0, 1.0, -1.0])),
            ["lateral_force_sign"]
        );
        // At a right angle the wheel is dragged, and no pull has a sign.
        let dragged = braked.map(|[slip, load, _, channels @ ..]| {
            let [pull, torque, sinkage, side] = channels;
            [slip, load, 90.0, -pull, -torque, sinkage, side]
        });
        assert_eq!(asked(&dragged), none);
    }
}
