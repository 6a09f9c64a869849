//! Soil that the buried side of the wheel pushes at a slip angle.

use super::surfaces::{Surface, across};
use crate::scene::{Track, smooth};
use crate::validation::side_wall::{closed_form, entered};
use scm::Averages;
use scm::spatial::Shape;

/// Returns a smooth wheel, 18 mm deep at a slip angle `[rad]`, that travels 0.3 m.
fn track(slip_angle_rad: f64) -> Track {
    let mut track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.3, 0.15);
    track.case.condition.slip_angle_rad = slip_angle_rad;
    track.case.soil.k_phi = 1.5e6;
    track.site.density_kg_m3 = Some(1500.0);
    track
}

#[test]
fn straight_ahead_there_is_no_side_wall_bit_for_bit() {
    let mut track = track(0.0);
    let base = track.roll();
    track = entered(track, 4.0, 0.3);
    assert_eq!(track.roll(), base);
}

#[test]
fn without_friction_it_changes_the_lateral_force_alone() {
    let track = track(0.3);
    let base = track.averages();
    let with = entered(track, 1.0, 0.0).averages();
    assert!(with.lateral_force_n > base.lateral_force_n);
    let bits = |a: &Averages| [a.drawbar_pull_n, a.torque_n_m, a.sinkage_m].map(f64::to_bits);
    assert_eq!(bits(&with), bits(&base));
}

#[test]
fn friction_on_the_side_acts_against_the_sliding_and_carries_load() {
    let mut track = track(0.3);
    let change = |track: &Track| {
        let bare = entered(track.clone(), 10.0, 0.0).averages();
        let rubbed = entered(track.clone(), 10.0, 0.5).averages();
        println!("{bare:?}\n{rubbed:?}");
        [
            rubbed.drawbar_pull_n - bare.drawbar_pull_n,
            rubbed.torque_n_m - bare.torque_n_m,
            rubbed.sinkage_m - bare.sinkage_m,
        ]
    };
    // in drive the buried side slides backwards, in skid forwards; in both its front goes down
    let [pull, torque, sinkage] = change(&track);
    assert!(pull > 0.1 && torque > 0.02 && sinkage < 0.0);
    track.case.condition.slip = -0.4;
    let [pull, torque, _] = change(&track);
    assert!(pull < -0.1 && torque < -0.02, "{pull} {torque}");
}

#[test]
fn opposite_angles_have_opposite_forces() {
    let [left, right] = [0.3, -0.3].map(|angle| {
        let base = track(angle).averages().lateral_force_n;
        entered(track(angle), 10.0, 0.3).averages().lateral_force_n - base
    });
    println!("{left} N, {right} N");
    assert!(left > 1.0 && (left + right).abs() < 0.02 * left, "{left} {right}");
}

#[test]
fn a_heap_of_soil_that_flows_aside_adds_to_it() {
    let change = |flow_fraction: f64| {
        let mut track = track(0.3);
        track.ground.flow_fraction = flow_fraction;
        let base = track.averages();
        let with = entered(track.clone(), 1.0, 0.0).averages();
        (with.lateral_force_n - base.lateral_force_n) / closed_form(&track, base.sinkage_m)
    };
    let (none, heaped) = (change(0.0), change(0.5));
    println!("{none:.4} and {heaped:.4} of the force without a heap");
    assert!((none - 1.0).abs() < 0.02 && heaped > 1.05, "{none} {heaped}");
}

#[test]
fn a_mesh_of_the_wheel_has_the_same_side() {
    let change = |shape: Shape| {
        let mut track = track(0.3);
        track.shape = shape;
        let base = track.averages().lateral_force_n;
        entered(track, 1.0, 0.3).averages().lateral_force_n - base
    };
    let surface = Surface::default().rim(0.125, 360, &across(0.112, 4), |_| 1.0).0;
    let (mesh, rim) = (change(Shape::from(surface)), change(track(0.3).shape));
    println!("{mesh} N, {rim} N");
    assert!((mesh / rim - 1.0).abs() < 0.03, "{mesh} {rim}");
}

#[test]
fn without_a_density_or_with_a_negative_strength_it_is_refused() {
    let mut unknown = track(0.3);
    unknown.site.density_kg_m3 = None;
    for (track, scale, friction, words) in [
        (unknown, 1.0, 0.3, "density_kg_m3 = NaN kg/m^3 must be known"),
        (
            track(0.3),
            -1.0,
            0.3,
            "passive_scale = -1 (dimensionless) must be at least 0",
        ),
        (
            track(0.3),
            1.0,
            -0.3,
            "wall_friction = -0.3 (dimensionless) must be at least 0",
        ),
    ] {
        let refused = entered(track, scale, friction).try_roll();
        let message = refused.expect_err("a refusal").to_string();
        assert!(message.contains(words), "{message}");
    }
}
