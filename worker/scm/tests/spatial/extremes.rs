//! Ends of the ranges: hard and soft ground, deep and slow, negative cohesive modulus.

use crate::scene::{Track, both, grousered, range, smooth};
use crate::support::{assert_near, base};

#[test]
fn hard_ground_is_resolved_by_eight_nodes_along_the_travel() {
    let mut track = smooth(0.2, 100.0, 30.0);
    track.case.soil.k_phi = 1e10;
    let got = track.averages();
    let paper = track.case.simulate();
    let lanes = 28;
    assert!(paper.contact_length_m < 0.0045, "{paper:?}");
    assert!(got.nodes_in_contact >= 8 * lanes, "{got:?}");
    // The soil unloads at 1e9 Pa/m, as stiff as it loads: a contact longer than the rigid-plastic one, and little resistance.
    assert!(got.contact_length_m > paper.contact_length_m, "{got:?}");
    assert_near(&got, &paper, [3.0, 0.1, f64::INFINITY]);
}

#[test]
fn hard_soil_needs_no_finer_grid_than_its_elastic_layer() {
    // with n = 0.8 and without the layer, a smooth wheel would touch this soil over 0.7 mm
    for grousers in [false, true] {
        let mut track = smooth(0.2, 100.0, 30.0);
        (track.case.soil.k_phi, track.case.soil.n) = (1e10, 0.8);
        if grousers {
            track = Track::with_grousers(track.case);
        }
        let mut finer = track.clone();
        finer.settings.dem_spacing_m = 0.9e-3; // the finest grid for this width
        let (got, fine) = (track.averages(), finer.averages());
        assert_near(&got, &fine, [0.1, 0.01, f64::INFINITY]);
        assert!((got.sinkage_m - fine.sinkage_m).abs() < 2e-5, "{got:?} {fine:?}");
    }
}

#[test]
fn a_wheel_sunk_to_three_quarters_of_its_radius_agrees_with_the_quasi_static_one() {
    for (k_phi, sinkage) in [(1e6, 0.023), (3e5, 0.048), (1e5, 0.0955)] {
        let mut track = smooth(0.2, 100.0, 30.0);
        track.case.soil.k_phi = k_phi;
        let (got, paper) = (track.averages(), track.case.simulate());
        // such soft soil hardly rebounds: the agreement is closer than at 1e7
        assert_near(&got, &paper, [0.5, 0.02, 0.005]);
        assert!((got.sinkage_m - sinkage).abs() < 1e-3);
    }
}

#[test]
fn cohesive_modulus_acts_through_the_contour() {
    // k* = k_phi + k_c (l + b) / (l b); stiff ground shows its rebound, soft ground does not
    for (share, sinkage) in [(-0.02, 0.01), (-0.01, 0.03), (0.02, 0.06), (0.05, 0.07)] {
        let mut track = smooth(0.2, 100.0, 30.0);
        track.case.soil.k_c = share * track.case.soil.k_phi;
        let (got, paper) = (track.averages(), track.case.simulate());
        assert_near(&got, &paper, [2.0, f64::INFINITY, sinkage]);
        assert!(
            (got.b_eff_m / paper.b_eff_m - 1.0).abs() < 0.04,
            "{got:?} {paper:?}"
        );
    }
}

#[test]
fn forces_depend_on_speed_by_the_slip_velocity_alone() {
    // a hundred times slower, on soil with a hundredth of the reference velocity
    for track in both() {
        let mut slow = track.clone();
        slow.case.condition.sled_speed_m_s *= 0.01;
        slow.case.soil.shear_velocity_m_s *= 0.01;
        // rounding may end a search at another trial
        assert_near(&slow.averages(), &track.averages(), [0.2, f64::INFINITY, 0.01]);
    }
}

#[test]
fn at_a_creep_the_strength_is_not_mobilised() {
    let mut track = smooth(0.2, 100.0, 30.0);
    track.case.condition.sled_speed_m_s = 1e-6;
    let (got, paper) = (track.averages(), track.case.simulate());
    assert!(got.torque_n_m > 0.0 && got.torque_n_m < 0.01, "{got:?}");
    assert_near(&got, &paper, [1.2, f64::INFINITY, f64::INFINITY]);
}

#[test]
fn a_locked_wheel_with_grousers_is_dragged() {
    let mut track = grousered(-1.0);
    track.case.condition.sled_speed_m_s = 0.01;
    let run = track.roll();
    let got = run.averages;
    assert!(got.drawbar_pull_n < -60.0 && got.torque_n_m < -7.0, "{got:?}");
    // nothing turns, so nothing oscillates once the wheel is in its rut
    let last = &run.history.sinkage_m[run.history.len() / 2..];
    assert!(range(last) < 2e-4, "{}", range(last));
}

#[test]
fn hard_ground_under_a_wheel_that_does_not_slip_takes_no_power_and_is_no_gain() {
    // on tips of 9 mm a wheel of 125 mm rolls as one of 134 mm: no slip at 1 - 125/134 = 0.067 of skid
    let mut track = Track::with_grousers(base(-0.067, 100.0, 22.0));
    track.case.soil.k_phi = 1e11;
    track.case.condition.sled_speed_m_s = 0.04;
    let power = track.roll().dissipated_power_w;
    assert!(power.abs() < 0.02 * 100.0 * 0.04, "{power} W");
    // soil that only unloads takes no power either, under a wheel without friction
    let mut track = smooth(0.2, 40.0, 0.0);
    (track.case.soil.n, track.case.soil.gamma_exponent) = (0.5, 0.0);
    let power = track.roll().dissipated_power_w;
    assert!(power.abs() < 1e-3 * 40.0 * 0.008, "{power} W");
}

#[test]
fn a_wheel_pushed_sideways_meets_new_soil() {
    // Without drift the wheel would stay on the soil pressed when it was lowered, at 3.7 mm.
    let mut track = smooth(0.2, 100.0, 30.0);
    track.case.condition.slip_angle_rad = 1.5;
    let (got, paper) = (track.averages(), track.case.simulate());
    assert_near(&got, &paper, [f64::INFINITY, f64::INFINITY, 0.07]);
    assert!(
        (got.lateral_force_n - paper.lateral_force_n).abs() < 1.0,
        "{got:?}"
    );
    // the opposite angle gives the same
    track.case.condition.slip_angle_rad = -1.5;
    assert!((got.lateral_force_n + track.averages().lateral_force_n).abs() < 0.5);
}
