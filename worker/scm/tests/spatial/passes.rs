//! The wheel in its own rut.

use crate::scene::{Track, smooth};
use crate::support::base;
use scm::Averages;
use scm::spatial::{Displacement, Protocol};

fn passes(mut track: Track) -> Vec<Averages> {
    track.settings.protocol = Protocol::Steady {
        tolerance: 0.005,
        most_travel_m: 0.4,
    };
    (1..=4)
        .map(|pass| {
            track.case.condition.pass = pass;
            track.averages()
        })
        .collect()
}

#[test]
fn every_pass_deepens_the_rut_by_less_than_the_one_before() {
    for track in [
        smooth(0.2, 100.0, 30.0),
        Track::with_grousers(base(0.2, 100.0, 30.0)),
    ] {
        let passes = passes(track);
        let deeper: Vec<f64> = passes
            .windows(2)
            .map(|pair| pair[1].sinkage_m - pair[0].sinkage_m)
            .collect();
        // the second pass meets soil that the first has pressed: its sinkage is far smaller
        assert!(deeper[0] < 0.5 * passes[0].sinkage_m, "{deeper:?}");
        assert!(deeper.iter().all(|&d| d > 1e-4), "{deeper:?}");
        assert!(deeper[1] < deeper[0] && deeper[2] < deeper[1], "{deeper:?}");
    }
}

#[test]
fn a_wheel_in_its_rut_pulls_more_for_it_compacts_less() {
    for track in [
        smooth(0.2, 100.0, 30.0),
        Track::with_grousers(base(0.2, 100.0, 30.0)),
    ] {
        let passes = passes(track);
        assert!(
            passes
                .windows(2)
                .all(|pair| pair[1].drawbar_pull_n > pair[0].drawbar_pull_n),
            "{passes:?}"
        );
        // at most the full strength over the load
        assert!(passes[3].drawbar_pull_n < 100.0 * 30_f64.to_radians().tan());
        assert!(
            passes[3].contact_length_m < 0.7 * passes[0].contact_length_m,
            "{passes:?}"
        );
    }
}

#[test]
fn a_displacement_law_starts_anew_in_every_pass() {
    for keeper in [Displacement::Rim, Displacement::Node] {
        let mut track = smooth(0.2, 100.0, 30.0);
        track.enter_displacement_law(0.01);
        track.settings.displacement = keeper;
        let passes = passes(track);
        // The contact is shorter, so less is mobilised. Without the reset, a node's strength would be fully mobilised.
        assert!(passes[1].torque_n_m < passes[0].torque_n_m, "{passes:?}");
    }
}

#[test]
fn an_element_of_the_rim_starts_anew_after_a_turn() {
    // one turn is 0.63 m of travel at a slip of 0.2
    let mut track = smooth(0.2, 100.0, 30.0);
    track.enter_displacement_law(0.01);
    let first_turn = track.clone().for_a_travel_of(0.4, 0.2).averages();
    let second_turn = track.for_a_travel_of(1.1, 0.2).averages();
    assert!(
        (first_turn.torque_n_m - second_turn.torque_n_m).abs() < 0.05,
        "{second_turn:?}"
    );
}
