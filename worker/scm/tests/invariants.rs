//! Invariants that hold for all parameters.

use crate::support::{Draws, assert_near, base};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn mirrored_slip_angle_mirrors_the_lateral_force_alone(seed: u64) {
        let mut case = Draws(seed).case();
        case.condition.slip_angle_rad = 0.1 + case.condition.slip_angle_rad.abs();
        let mut mirrored = case;
        mirrored.condition.slip_angle_rad = -case.condition.slip_angle_rad;
        let (Ok(left), Ok(mut right)) = (case.try_simulate(), mirrored.try_simulate()) else { return Ok(()) };
        prop_assert!(left.lateral_force_n > 0.0);
        right.lateral_force_n = -right.lateral_force_n;
        prop_assert_eq!(left, right); // equal to the last bit
    }

    #[test]
    fn stiffer_soil_under_a_greater_load_scales_the_forces_and_keeps_the_sinkage(seed: u64, factor in 0.2..5.0_f64) {
        let mut case = Draws(seed).case();
        case.soil.cohesion_pa = 0.0;
        let mut scaled = case;
        scaled.soil.k_c *= factor;
        scaled.soil.k_phi *= factor;
        scaled.condition.wheel_load_n *= factor;
        let Ok(got) = case.try_simulate() else { return Ok(()) };
        let expected = scaled.simulate();
        let tolerance = 1e-6 * case.condition.wheel_load_n;
        prop_assert!((got.sinkage_m / expected.sinkage_m - 1.0).abs() < 1e-7);
        prop_assert!((got.drawbar_pull_n - expected.drawbar_pull_n / factor).abs() < tolerance);
        prop_assert!((got.torque_n_m - expected.torque_n_m / factor).abs() < tolerance);
    }

    #[test]
    fn motor_and_sled_never_draw_power_from_the_soil(seed: u64) {
        let case = Draws(seed).case();
        let Ok(got) = case.try_simulate() else { return Ok(()) };
        let (sin_beta, cos_beta) = case.condition.slip_angle_rad.sin_cos();
        let v = case.condition.sled_speed_m_s;
        let power = got.torque_n_m * case.omega() - got.drawbar_pull_n * v * cos_beta
            + got.lateral_force_n * v * sin_beta;
        prop_assert!(power > 0.0, "{power} W");
    }

    #[test]
    fn the_soil_carries_the_load_and_the_channels_are_finite(seed: u64) {
        let case = Draws(seed).case();
        let Ok(got) = case.try_simulate() else { return Ok(()) };
        prop_assert!(got.residual_load_n.abs() <= 1e-9 * case.condition.wheel_load_n);
        prop_assert!(got.sinkage_m > 0.0 && got.sinkage_m < case.wheel.radius_m);
        prop_assert!(got.contact_length_m > got.b_eff_m && got.nodes_in_contact >= 16);
        prop_assert!(got.drawbar_pull_n.is_finite() && got.torque_n_m.is_finite());
    }
}

#[test]
fn motor_gives_at_least_the_power_that_the_sled_takes() {
    // base case: T omega = 0.48 W, F v = 0.29 W
    let case = base(0.2, 100.0, 30.0);
    let got = case.simulate();
    assert!((got.torque_n_m * case.omega() - 0.48).abs() < 0.01, "{got:?}");
    assert!((got.drawbar_pull_n * case.condition.sled_speed_m_s - 0.29).abs() < 0.01);
}

#[test]
fn slip_comes_from_the_radius_of_the_rig() {
    // s_true = 1 − (1 − s) R_s / R = 1 − 0.8 · 0.125 / 0.15 = 1/3
    let mut by_rig = base(0.2, 100.0, 30.0);
    by_rig.wheel.radius_m = 0.15;
    let mut by_model = by_rig;
    by_model.wheel.rig_radius_m = 0.15;
    by_model.condition.slip = 1.0 - (1.0 - 0.2) * 0.125 / 0.15;
    assert_near(
        &by_rig.simulate(),
        &by_model.simulate(),
        [1e-6, 1e-7, f64::INFINITY],
    );
}

#[test]
fn locked_wheel_is_dragged_against_motor_and_sled() {
    let mut case = base(-1.0, 100.0, 30.0);
    case.condition.sled_speed_m_s = 0.01;
    let got = case.simulate();
    assert!(got.torque_n_m < 0.0 && got.drawbar_pull_n < -50.0, "{got:?}");
}

#[test]
fn drawbar_pull_and_torque_rise_with_slip() {
    let runs = [-0.5, -0.1, 0.0, 0.05, 0.2, 0.6, 0.9].map(|slip| {
        let mut case = base(slip, 100.0, 30.0);
        case.condition.sled_speed_m_s = 0.01;
        case.simulate()
    });
    for pair in runs.windows(2) {
        assert!(pair[0].drawbar_pull_n < pair[1].drawbar_pull_n, "{pair:?}");
        assert!(pair[0].torque_n_m < pair[1].torque_n_m, "{pair:?}");
    }
}

#[test]
fn pass_does_not_matter_to_a_soil_without_memory() {
    let mut case = base(0.2, 100.0, 30.0);
    let first = case.simulate();
    case.condition.pass = 3;
    assert_eq!(first, case.simulate());
}
