//! The end of a run, and its averaged part.

use crate::scene::{both, grousered, range, smooth};
use crate::support::assert_near;
use scm::spatial::Protocol;

#[test]
fn a_settled_run_has_the_means_of_a_long_one() {
    for track in both() {
        let steady = track.roll();
        let settled_to = steady.settled_to.expect("a steady protocol");
        let long = track.for_a_travel_of(1.0, 0.8).averages();
        let got = steady.averages;
        assert!(settled_to <= 0.005, "{settled_to}");
        assert!(got.simulated_travel_m < 0.5, "{got:?}");
        // windows that agree to 0.5 % may be as far from their limit
        assert_near(&got, &long, [0.5, 0.05, 0.01]);
    }
}

#[test]
fn a_run_that_cannot_settle_is_reported() {
    let mut track = grousered(0.2);
    track.end_steady(1e-9, 0.3);
    let run = track.roll();
    assert!(run.settled_to.expect("a steady protocol") > 1e-9);
    // five contact lengths and a window of two periods of 52 mm; a sixth does not fit and is not begun
    let contacts = (run.averages.simulated_travel_m - 2.0 * 0.052_36) / run.averages.contact_length_m;
    assert!((contacts - 5.0).abs() < 0.2, "{contacts}");
    // too short for the transient
    track.shape = smooth(0.2, 100.0, 30.0).shape;
    track.end_steady(0.005, 0.1);
    let run = track.roll();
    assert!(run.settled_to.expect("a steady protocol") > 0.005);
    assert!(run.averages.simulated_travel_m > 0.099, "{:?}", run.averages);
    // too short for a window of one column
    track.end_steady(0.005, 0.002);
    let rejection = track.try_roll().expect_err("a rejection").to_string();
    let end = "must be long enough for a window of averages";
    assert!(rejection.ends_with(end), "{rejection}");
}

#[test]
fn the_remaining_travel_does_not_change_the_averages() {
    let sinkages = [0.30, 0.31, 0.32, 0.33, 0.34, 0.35, 0.36].map(|most_travel_m| {
        let mut track = grousered(0.2);
        track.end_steady(1e-9, most_travel_m);
        track.averages().sinkage_m
    });
    // means of successive periods differ by 1 %
    let min = sinkages.iter().copied().fold(f64::MAX, f64::min);
    assert!(range(&sinkages) < 0.01 * min, "{sinkages:?}");
}

#[test]
fn a_wheel_that_hardly_turns_gets_room_for_two_periods_or_counts_as_locked() {
    // 65 mm of rim between grousers take 0.65 m of travel at a slip of −0.9, and 6.5 m at −0.99; with the transient and
    // without another period to compare with it has settled after 0.73 m
    let travel = |slip: f64| {
        let mut track = grousered(-0.3);
        track.case.condition.slip = slip;
        track.settings.dem_spacing_m = 0.008;
        track.roll().averages.simulated_travel_m
    };
    assert!((travel(-0.9) - 0.73).abs() < 0.02, "{}", travel(-0.9));
    assert!(travel(-0.99) < 1.0);
}

#[test]
fn a_low_pass_leaves_the_means_of_whole_periods_alone() {
    let track = grousered(0.2).for_a_travel_of(0.8, 0.5);
    let plain = track.averages();
    let mut filtered = track;
    if let Protocol::Fixed { lowpass_hz, .. } = &mut filtered.settings.protocol {
        *lowpass_hz = 0.5; // three times the grousers' 0.153 Hz
    }
    let filtered = filtered.averages();
    assert_near(&plain, &filtered, [0.2, f64::INFINITY, 0.005]);
    assert!(plain != filtered, "the filter does something");
}

#[test]
fn transients_are_cut() {
    let track = smooth(0.2, 100.0, 30.0);
    let cut = track.clone().for_a_travel_of(0.2, 0.1).averages();
    let whole = track.for_a_travel_of(0.2, 0.2).averages();
    // both halves of the contact carry a lowered wheel, which sinks only 3.7 mm
    assert!(whole.sinkage_m < 0.98 * cut.sinkage_m, "{whole:?} {cut:?}");
}

#[test]
fn histories_hold_every_step_and_their_means_are_the_averages() {
    let track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.2, 0.1);
    let run = track.roll();
    let steps = run.history.len() - 1;
    let travelled = steps as f64 * run.history.step_s * track.case.condition.sled_speed_m_s;
    assert!((travelled - 0.2).abs() < 5.1e-4, "{travelled}");
    let last = run.history.drawbar_pull_n.iter().rev().take(steps / 2);
    let mean = last.sum::<f64>() / (steps / 2) as f64;
    // averages use whole samples at 10 Hz
    assert!((mean - run.averages.drawbar_pull_n).abs() < 0.05, "{mean}");
    // every step carries the load to the search's 1.5 %, and the next step compensates the residual, so it never accumulates
    let load = &run.history.wheel_load_n;
    assert!(load.iter().all(|w| (w - 100.0).abs() < 3.0));
    let mut surplus = 0.0;
    for w in load {
        surplus += w - 100.0;
        assert!(surplus.abs() < 1.5, "{surplus}");
    }
}
