//! Parameters without an answer are distinguished from faults, with the numbers that show why.

use crate::support::{Case, base};
use scm::Rejection;

fn rejection(case: &Case) -> Rejection {
    case.try_simulate().expect_err("a rejection")
}

#[test]
fn too_soft_a_soil_gives_no_support_and_names_the_most_it_carries() {
    let mut case = base(0.2, 100.0, 30.0);
    case.soil.k_phi = 1e4;
    let refused = rejection(&case);
    let message = refused.to_string();
    assert!(
        message.starts_with("no support: the soil carries at most "),
        "{message}"
    );
    let end = " N of the 100 N wheel load before the sinkage reaches the wheel radius 0.125 m";
    assert!(message.ends_with(end), "{message}");
    assert_eq!(refused.kind(), "no_support");
    // the number is correct: a slightly smaller load is carried
    let Rejection::NoSupport { max_carried_n, .. } = refused else {
        panic!("{message}")
    };
    case.condition.wheel_load_n = 0.999 * max_carried_n;
    assert!(case.simulate().sinkage_m < 0.125);
}

#[test]
fn negative_cohesive_modulus_is_rejected_only_where_no_footprint_supports() {
    let mut case = base(0.2, 100.0, 30.0);
    // k* > 0 needs b_eff > 20 mm, l > 24.3 mm, z > 2.4 mm
    case.soil.k_c = -0.02 * case.soil.k_phi;
    let got = case.simulate();
    assert!(got.b_eff_m > 0.02 && got.sinkage_m > 2.4e-3, "{got:?}");
    // k* < 0 for every footprint on this width
    case.soil.k_c = -0.113 * case.soil.k_phi;
    assert_eq!(rejection(&case).kind(), "no_support");
}

#[test]
fn razor_thin_slab_of_support_is_balanced() {
    let mut case = base(0.2, 100.0, 30.0);
    (case.soil.k_c, case.soil.k_phi) = (-1.45e8, 5e9);
    let got = case.simulate();
    let k_star = case.soil.k_c / got.b_eff_m + case.soil.k_phi;
    assert!(k_star > 0.0 && k_star < 0.01 * case.soil.k_phi, "{got:?}");
    assert!(got.residual_load_n.abs() < 1e-7);
}

#[test]
fn cohesion_at_a_footprint_without_stiffness_is_no_balance() {
    // at b_eff = 80 mm k* passes zero and cohesion alone lifts more than the load
    let mut case = base(0.9, 1.0, 30.0);
    case.condition.sled_speed_m_s = 0.01;
    (case.soil.k_c, case.soil.cohesion_pa) = (-0.05 * 1e7, 5_000.0);
    assert_eq!(rejection(&case).kind(), "no_convergence", "{}", rejection(&case));
}

#[test]
fn overflow_is_rejected_as_not_finite() {
    let mut case = base(0.2, 100.0, 30.0);
    (case.soil.k_phi, case.soil.k_c) = (f64::MAX, f64::MAX);
    assert_eq!(rejection(&case).kind(), "not_finite", "{}", rejection(&case));
}

#[test]
fn every_field_outside_its_bounds_is_named_with_value_unit_and_bound() {
    type Change = fn(&mut Case);
    let changes: [(&str, Change); 16] = [
        ("k_c", |case| case.soil.k_c = f64::NAN),
        ("k_phi", |case| case.soil.k_phi = -1.0),
        ("n", |case| case.soil.n = 0.0),
        ("cohesion_pa", |case| case.soil.cohesion_pa = -1.0),
        ("friction_angle_rad", |case| case.soil.friction_angle_rad = 30.0),
        ("shear_velocity_m_s", |c| {
            c.soil.shear_velocity_m_s = f64::INFINITY
        }),
        ("gamma_exponent", |case| case.soil.gamma_exponent = -0.5),
        ("radius_m", |case| case.wheel.radius_m = 0.0),
        ("width_m", |case| case.wheel.width_m = f64::NAN),
        ("rig_radius_m", |case| case.wheel.rig_radius_m = -0.125),
        ("slip", |case| case.condition.slip = 1.0),
        ("slip", |case| case.condition.slip = -1.01),
        ("wheel_load_n", |case| case.condition.wheel_load_n = 0.0),
        ("sled_speed_m_s", |case| case.condition.sled_speed_m_s = 0.0),
        ("slip_angle_rad", |case| case.condition.slip_angle_rad = 45.0),
        ("pass", |case| case.condition.pass = 0),
    ];
    for (field, change) in changes {
        let mut case = base(0.2, 100.0, 30.0);
        change(&mut case);
        let rejection = rejection(&case);
        assert_eq!(rejection.kind(), "invalid_parameter");
        let begin = format!("invalid parameter: {field} = ");
        assert!(rejection.to_string().starts_with(&begin), "{rejection}");
    }
    let mut case = base(0.2, 100.0, 30.0);
    case.condition.wheel_load_n = -5.0;
    let expected = "invalid parameter: wheel_load_n = -5 N must be above 0";
    assert_eq!(rejection(&case).to_string(), expected);
}
