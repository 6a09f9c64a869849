//! The choices that determine the figures of another implementation.

use crate::scene::Track;
use crate::validation::other_implementation::track;
use scm::spatial::{Displacement, PressureDirection};

/// Differences of drawbar pull `[N]`, torque \[N m\] and sinkage `[mm]` by a change of the comparison's track.
fn change(modify: fn(&mut Track)) -> [f64; 3] {
    let before = track(0.005).averages();
    let mut changed = track(0.005);
    modify(&mut changed);
    let after = changed.averages();
    [
        after.drawbar_pull_n - before.drawbar_pull_n,
        after.torque_n_m - before.torque_n_m,
        1e3 * (after.sinkage_m - before.sinkage_m),
    ]
}

#[test]
fn pressure_along_the_wheels_normal_adds_the_compaction_resistance() {
    // R_c = b k z^(n+1)/(n+1) = 16 N at 15 mm, less the part that the lift of the shear saves, because it carries some of the load
    let [pull, _, sinkage] =
        change(|track| track.settings.pressure_direction = PressureDirection::WheelNormal);
    assert!(pull < -5.0 && sinkage < -0.2, "{pull} {sinkage}");
}

#[test]
fn displacement_of_the_rim_is_less_than_that_of_the_soil() {
    // The wheel passes a node at the sled's speed v and takes an element of its rim through the soil at v / (1 − s), so the
    // element slides 1 − s times as far.
    let [pull, _, sinkage] = change(|track| track.settings.displacement = Displacement::Rim);
    assert!(pull < -3.0 && sinkage.abs() < 0.01, "{pull} {sinkage}");
}

#[test]
fn strength_is_half_mobilised_by_the_displacement() {
    let [pull, _, _] = change(|track| track.effects.clear());
    assert!(pull > 25.0, "{pull}"); // W tan(phi) = 57.7 N in all
}

#[test]
fn stiffer_unloading_takes_the_contact_behind_the_axle_away() {
    let [pull, _, sinkage] = change(|track| track.ground.elastic_stiffness_pa_m = 1e10);
    assert!(pull < -0.5 && sinkage > 0.8, "{pull} {sinkage}");
}
