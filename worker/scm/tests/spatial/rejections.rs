//! Parameters without an answer, and impossible wheels, soils and grids.

use crate::scene::{Track, bars, grousered, smooth};
use scm::spatial::{Protocol, Shape, Vertical};

fn rejection(track: &Track) -> scm::Rejection {
    track.try_roll().expect_err("a rejection")
}

#[track_caller]
fn assert_named(track: &Track, field: &str) {
    let message = rejection(track).to_string();
    assert!(
        message.starts_with(&format!("invalid parameter: {field} = ")),
        "{message}"
    );
}

fn dynamic(damping_n_s_m: f64, gravity_m_s2: f64) -> Vertical {
    Vertical::Dynamic {
        damping_n_s_m,
        gravity_m_s2,
    }
}

#[test]
fn too_soft_a_soil_gives_no_support_and_names_the_most_it_carries() {
    let mut track = smooth(0.2, 100.0, 30.0);
    track.case.soil.k_phi = 1e4;
    let refused = rejection(&track);
    let scm::Rejection::NoSupport { max_carried_n, .. } = refused else {
        panic!("{refused}")
    };
    // the number is correct for the lowered wheel: a slightly smaller load is carried
    track.case.condition.wheel_load_n = 0.9 * max_carried_n;
    let lowered = track.clone().for_a_travel_of(0.1, 0.05).roll();
    assert!(lowered.history.sinkage_m[0] > 0.08, "{max_carried_n}");
    // a negative cohesive modulus for which no footprint of this width has support
    let mut track = smooth(0.2, 100.0, 30.0);
    track.case.soil.k_c = -0.113 * track.case.soil.k_phi;
    assert_eq!(rejection(&track).kind(), "no_support");
}

#[test]
fn every_choice_outside_its_bounds_is_named() {
    type Change = fn(&mut Track);
    let fixed = |duration_s, transient_force_s, transient_sinkage_s, lowpass_hz| Protocol::Fixed {
        duration_s,
        transient_force_s,
        transient_sinkage_s,
        lowpass_hz,
    };
    let steady = |tolerance, most_travel_m| Protocol::Steady {
        tolerance,
        most_travel_m,
    };
    let changes: [(&str, Change); 13] = [
        ("elastic_stiffness_pa_m", |t| {
            t.ground.elastic_stiffness_pa_m = 0.0
        }),
        ("flow_fraction", |t| t.ground.flow_fraction = 1.01),
        ("bearing_credit", |t| t.ground.bearing_credit = -0.01),
        ("repose_angle_rad", |t| t.ground.repose_angle_rad = 32.0),
        ("grouser_height_m", |t| t.shape = Shape::Rim(bars(12, 0.0, 0.002))),
        ("grouser_thickness_m", |t| {
            t.shape = Shape::Rim(bars(12, 0.009, -0.002))
        }),
        ("dem_spacing_m", |t| t.settings.dem_spacing_m = 0.0),
        ("travel_step_m", |t| t.settings.travel_step_m = f64::INFINITY),
        ("damping_n_s_m", |t| t.settings.vertical = dynamic(-1.0, 9.81)),
        ("gravity_m_s2", |t| t.settings.vertical = dynamic(1.0, 0.0)),
        ("slip", |t| t.case.condition.slip = 1.0),
        ("n", |t| t.case.soil.n = 0.0),
        ("radius_m", |t| t.case.wheel.radius_m = 0.0),
    ];
    for (field, change) in changes {
        let mut track = smooth(0.2, 100.0, 30.0);
        change(&mut track);
        assert_named(&track, field);
    }
    for (field, protocol) in [
        ("tolerance", steady(0.0, 1.0)),
        ("most_travel_m", steady(0.01, -1.0)),
        ("duration_s", fixed(0.0, 0.0, 0.0, 0.0)),
        ("transient_force_s", fixed(50.0, 50.0, 0.0, 0.0)),
        ("transient_sinkage_s", fixed(50.0, 20.0, -1.0, 0.0)),
        ("lowpass_hz", fixed(50.0, 20.0, 1.0, -0.5)),
    ] {
        let mut track = smooth(0.2, 100.0, 30.0);
        track.settings.protocol = protocol;
        assert_named(&track, field);
    }
}

#[test]
fn a_wheel_of_more_lanes_than_can_be_kept_apart_is_refused_and_the_bound_is_true() {
    for (slip_angle, lanes) in [(0.0, 126.0), (0.1, 62.0)] {
        let mut track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.01, 0.005);
        track.case.condition.slip_angle_rad = slip_angle;
        track.settings.dem_spacing_m = 0.112 / (lanes + 3.0);
        assert_named(&track, "dem_spacing_m");
        let message = rejection(&track).to_string();
        let end = "1/62 of the wheel's width, 1/126 where the slip angle is 0";
        assert!(message.ends_with(end), "{message}");
        track.settings.dem_spacing_m = 0.112 / lanes;
        assert!(track.try_roll().is_ok(), "{lanes} lanes");
    }
}

#[test]
fn a_filter_that_cannot_follow_the_samples_is_refused() {
    let mut track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.1, 0.05);
    if let Protocol::Fixed { lowpass_hz, .. } = &mut track.settings.protocol {
        *lowpass_hz = 6.0; // above half of 10 Hz
    }
    assert_eq!(rejection(&track).kind(), "protocol");
}

#[test]
fn runs_too_large_to_compute_are_named_and_not_begun() {
    type Change = fn(&mut Track);
    let changes: [(&str, Change); 6] = [
        // steps of a millimetre of rim, a hundred metres of rim per millimetre of travel
        ("steps of the run", |t| t.case.condition.slip = 0.999_99),
        ("steps of the run", |t| t.settings.travel_step_m = 1e-9),
        ("steps of the run", |t| t.case.condition.pass = 1_000_000),
        ("nodes of the terrain", |t| {
            (t.case.soil.k_phi, t.settings.travel_step_m) = (1e17, 1.0);
            t.ground.elastic_stiffness_pa_m = 1e17;
        }),
        ("sled_speed_m_s", |t| t.case.condition.sled_speed_m_s = 1e308),
        ("sled_speed_m_s", |t| t.case.condition.sled_speed_m_s = 5e-324),
    ];
    for (name, change) in changes {
        let mut track = grousered(0.2);
        change(&mut track);
        assert_named(&track, name);
    }
}

#[test]
fn grousers_that_no_wheel_has_room_for_are_named() {
    for (count, height_m, thickness_m, name) in [
        (12, 0.13, 0.002, "grouser_height_m"),
        (12, 0.009, 0.07, "grouser_thickness_m"),
        (500, 0.009, 0.002, "grouser_thickness_m"),
    ] {
        let mut track = smooth(0.2, 100.0, 30.0);
        track.shape = Shape::Rim(bars(count, height_m, thickness_m));
        let message = rejection(&track).to_string();
        assert!(message.contains(name), "{message}");
    }
}

#[test]
fn a_run_that_will_be_out_of_balance_is_refused_before_its_end() {
    let mut track = grousered(0.2).for_a_travel_of(0.4, 0.24);
    (track.case.soil.k_c, track.case.soil.k_phi, track.case.soil.n) = (-2.51e8, 6.61e9, 1.03);
    let Err(scm::Rejection::NoConvergence { evaluations, .. }) = track.try_roll() else {
        panic!("{track:?} finds a balance");
    };
    // the whole run would need twenty thousand evaluations
    assert!(evaluations < 2000, "{evaluations}");
}
