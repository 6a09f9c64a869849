//! In skid the carried load rises and falls with depth, and the wheel stops at the first balance.

use crate::support::{Case, base};
use scm::Rejection;

/// Returns a case with strong friction and a low exponent: in skid the carried load peaks well before z = R.
fn skidding(slip: f64, n: f64, wheel_load_n: f64) -> Case {
    let mut case = base(slip, wheel_load_n, 50.0);
    case.condition.sled_speed_m_s = 0.01;
    (case.soil.k_phi, case.soil.n, case.soil.shear_velocity_m_s) = (1e5, n, 1e-4);
    case
}

fn rejection(case: &Case) -> Rejection {
    case.try_simulate().expect_err("a rejection")
}

#[test]
fn of_three_balances_the_one_nearest_the_surface_is_taken() {
    // Computed by a prototype with 32 nodes: 191.3 N at z = 0.42 R, 175.3 N at 0.63 R, 272 N at R.
    let radius = 0.125;
    let depth = |load: f64| {
        let got = skidding(-0.6, 0.3, load).simulate();
        assert!(got.residual_load_n.abs() < 1e-6, "{load} N: {got:?}");
        got.sinkage_m / radius
    };
    for load in [176.0, 180.0, 185.0, 190.0, 191.0] {
        assert!(depth(load) < 0.42, "{load} N");
    }
    // The peak does not carry these loads: the wheel drops past the dip.
    for load in [192.0, 220.0, 270.0] {
        assert!(depth(load) > 0.63, "{load} N");
    }
}

#[test]
fn a_load_just_under_the_peak_is_carried_before_it_and_one_just_above_is_not() {
    // locked wheel, n = 0.5: 109.6 N at 0.55 R and less from there on
    let refused = rejection(&skidding(-1.0, 0.5, 1e4));
    let Rejection::NoSupport {
        max_carried_n: peak, ..
    } = refused
    else {
        panic!("{refused}")
    };
    assert!((peak - 109.6).abs() < 0.2, "{peak}");
    let mut last = 0.0;
    for parts in [0.01, 0.2, 0.5, 0.8, 0.99, 1.0 - 1e-6] {
        let sinkage = skidding(-1.0, 0.5, peak * parts).simulate().sinkage_m;
        assert!(last < sinkage && sinkage < 0.56 * 0.125, "{parts}: {sinkage}");
        last = sinkage;
    }
    let above = rejection(&skidding(-1.0, 0.5, peak * (1.0 + 1e-6)));
    assert_eq!(above.kind(), "no_support");
}

#[test]
fn cohesion_that_pulls_a_skidding_wheel_down_leaves_the_first_balance() {
    let mut case = base(-1.0, 30.0, 42.0);
    case.condition.sled_speed_m_s = 0.01;
    case.soil.k_phi = 2e5;
    let without = case.simulate();
    case.soil.cohesion_pa = 1_000.0;
    let with = case.simulate();
    assert!(with.sinkage_m > without.sinkage_m, "{with:?}");
    assert!(with.residual_load_n.abs() < 1e-7, "{with:?}");
}
