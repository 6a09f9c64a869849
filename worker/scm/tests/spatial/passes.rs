//! The wheel in its own rut.

use crate::scene::{Track, both, smooth};
use crate::support::assert_near;
use scm::Averages;
use scm::spatial::Displacement;

fn passes(mut track: Track) -> [Averages; 4] {
    track.end_steady(0.005, 0.4);
    let mut average = |pass| {
        track.case.condition.pass = pass;
        track.averages()
    };
    [1, 2, 3, 4].map(&mut average)
}

#[test]
fn every_pass_deepens_the_rut_by_less_than_the_one_before() {
    for track in both() {
        let passes = passes(track);
        let deeper = [0, 1, 2].map(|i| passes[i + 1].sinkage_m - passes[i].sinkage_m);
        // the second pass meets soil that the first has pressed: its sinkage is far smaller
        assert!(deeper[0] < 0.5 * passes[0].sinkage_m, "{deeper:?}");
        assert!(deeper.iter().all(|&d| d > 1e-4), "{deeper:?}");
        assert!(deeper[1] < deeper[0] && deeper[2] < deeper[1], "{deeper:?}");
    }
}

#[test]
fn a_wheel_in_its_rut_pulls_more_for_it_compacts_less() {
    for track in both() {
        let passes = passes(track);
        assert!(
            passes.map(|pass| pass.drawbar_pull_n).is_sorted_by(|a, b| a < b),
            "{passes:?}"
        );
        // at most the full strength over the load
        assert!(passes[3].drawbar_pull_n < 100.0 * 30_f64.to_radians().tan());
        let [first, .., last] = passes.map(|pass| pass.contact_length_m);
        assert!(last < 0.7 * first, "{passes:?}");
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
    assert_near(&first_turn, &second_turn, [f64::INFINITY, 0.05, f64::INFINITY]);
}
