//! Cases with hand-computed results.

use crate::support::base;
use scm::footprint::{effective_width, rectangle_effective_width};
use scm::pressure_sinkage::{k_star, pressure};

#[test]
fn plate_load_is_area_times_bekker_pressure() {
    // round plate of 40 mm radius, b_eff = r, 6 mm deep, k_c = 2e4, k_phi = 1e7, n = 1:
    // p = (2e4/0.04 + 1e7) 0.006 = 63 kPa, W = 63000 π 0.04² = 316.67 N
    let mut soil = base(0.2, 100.0, 30.0).soil;
    (soil.k_c, soil.n) = (2e4, 1.0);
    let radius = 0.04;
    let area = core::f64::consts::PI * radius * radius;
    let b_eff = effective_width(area, 2.0 * core::f64::consts::PI * radius);
    let load = area * pressure(k_star(&soil, b_eff), 0.006, soil.n);
    assert!((b_eff - radius).abs() < 1e-16);
    assert!((load - 316.672_5).abs() < 1e-3, "{load}");
}

#[test]
fn effective_width_of_a_rectangle_is_half_its_harmonic_mean() {
    // 39 mm by 112 mm: 39 · 112 / 151 = 28.927 mm
    assert!((rectangle_effective_width(0.039, 0.112) - 0.028_927_15).abs() < 1e-8);
}

#[test]
fn frictionless_wheel_sinks_as_bekker_and_tows_the_work_of_compaction() {
    let quarter_turn = core::f64::consts::FRAC_PI_4;
    for (n, shape) in [(1.0, 2.0 / 3.0), (1.1, 0.648_84), (0.5, quarter_turn)] {
        for load in [40.0, 100.0, 160.0] {
            let mut case = base(0.2, load, 0.0);
            (case.soil.n, case.soil.gamma_exponent) = (n, 0.0);
            let got = case.simulate();
            let (b, k, r) = (case.wheel.width_m, case.soil.k_phi, case.wheel.radius_m);
            let expected_load = b * k * got.sinkage_m.powf(n + 0.5) * (2.0 * r).sqrt() * shape;
            assert!((expected_load / load - 1.0).abs() < 0.03, "{n} {load} {got:?}");
            let resistance = b * k * got.sinkage_m.powf(n + 1.0) / (n + 1.0);
            // p dz/dx is the derivative of k z^(n+1)/(n+1): exact for any contour of the rim
            assert!((got.drawbar_pull_n / -resistance - 1.0).abs() < 1e-6, "{got:?}");
            assert!(got.torque_n_m.abs().max(got.lateral_force_n.abs()) < f64::MIN_POSITIVE);
        }
    }
}

#[test]
fn fully_mobilised_torque_of_a_shallow_contact_is_friction_times_load_times_radius() {
    let mut case = base(0.5, 100.0, 30.0);
    (case.soil.k_phi, case.soil.shear_velocity_m_s) = (1e10, 0.0);
    let got = case.simulate();
    let expected = 100.0 * case.wheel.radius_m * 30_f64.to_radians().tan();
    // T = R ∫ tau / cos(theta), W = ∫ p (1 + tan(phi) tan(theta)): the difference is of order theta_1
    let theta_1 = (1.0 - got.sinkage_m / case.wheel.radius_m).acos();
    assert!(theta_1 < 0.04, "{got:?}");
    assert!((got.torque_n_m / expected - 1.0).abs() < theta_1, "{got:?}");
}

#[test]
fn moduli_reproduce_the_reference_pressure_and_the_share_of_the_cohesive_term() {
    let (k_c, k_phi) = scm::bekker_moduli(4.5, -0.4, 1.2);
    let p_ref = (k_c / 0.03 + k_phi) * 0.01_f64.powf(1.2);
    assert!((p_ref.log10() - 4.5).abs() < 1e-12);
    assert!((k_c / (k_phi * 0.03) + 0.4).abs() < 1e-14);
}
