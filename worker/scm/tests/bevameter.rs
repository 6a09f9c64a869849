//! Plate and ring, compared with hand-computed figures.

use crate::support::base;
use scm::bevameter::{Plate, Ring, Unloading, plate, ring};
use scm::shear::ShearDisplacement;
use scm::{Rejection, Soil};

fn sand() -> Soil {
    base(0.2, 100.0, 30.0).soil
}

fn ring(inner_radius_m: f64, outer_radius_m: f64) -> Result<Ring, Rejection> {
    let ring = Ring {
        inner_radius_m,
        outer_radius_m,
    };
    ring.checked()
}

const SMALL: Plate = Plate::Circle { radius_m: 0.04 };

#[test]
fn a_plate_carries_its_area_times_bekkers_pressure() {
    // k_c = 2e4, k_phi = 1e7, n = 1, 6 mm: p = (2e4/0.04 + 1e7) 0.006 = 63 kPa, W = 63000 π 0.04² = 316.6725 N
    let soil = Soil {
        k_c: 2e4,
        n: 1.0,
        ..sand()
    };
    assert!((plate::pressure(&soil, &SMALL, 0.006).unwrap() - 63_000.0).abs() < 1e-9);
    assert!((plate::load(&soil, &SMALL, 0.006).unwrap() - 316.672_5).abs() < 1e-3);
    // b is the short side in either order: (2e4/0.05 + 1e7) 0.006 = 62.4 kPa on 0.05 · 0.2 m²
    for (length_m, width_m) in [(0.2, 0.05), (0.05, 0.2)] {
        let rectangle = Plate::Rectangle { length_m, width_m };
        assert!((plate::pressure(&soil, &rectangle, 0.006).unwrap() - 62_400.0).abs() < 1e-9);
        assert!((plate::load(&soil, &rectangle, 0.006).unwrap() - 624.0).abs() < 1e-9);
    }
}

#[test]
fn load_over_area_and_modulus_is_the_power_of_the_sinkage() {
    for n in [0.5, 1.0, 1.1, 1.7] {
        let soil = Soil { n, ..sand() };
        for z in [0.0, 1e-4, 3e-3, 0.03] {
            let got = plate::load(&soil, &SMALL, z).unwrap();
            let expected = SMALL.area_m2() * soil.k_phi * libm::pow(z, n);
            assert!((got - expected).abs() <= 1e-15 * expected, "n {n} z {z}: {got}");
        }
    }
}

#[test]
fn a_lifted_plate_follows_the_unloading_line_and_leaves_the_soil() {
    // n = 1: p_u = 1e7 · 0.01 = 100 kPa; k_u = 2e7 + 3e9 · 0.01 = 5e7 Pa/m; 1 mm up: 50 kPa; 2 mm up: 0
    let soil = Soil { n: 1.0, ..sand() };
    let springs = Unloading {
        stiffness_pa_per_m: 2e7,
        stiffening_pa_per_m2: 3e9,
    };
    let at = |z: f64| springs.pressure(&soil, &SMALL, 0.01, z).unwrap();
    assert!((at(0.01) - 1e5).abs() < 1e-9);
    assert!((at(0.009) - 5e4).abs() < 1e-6);
    assert!(at(0.0079).abs() < f64::MIN_POSITIVE);
    // Beyond the deepest sinkage the virgin curve applies, which the line meets.
    assert!((at(0.012) - 1.2e5).abs() < 1e-9);
    assert!((at(0.01 - 1e-12) - at(0.01)).abs() < 1e-3);
}

#[test]
fn strength_is_reached_by_way() {
    // c = 500 Pa, sigma = 20 kPa, phi = 30°: tau_max = 500 + 20000/√3 = 12047.005 Pa; 1 − 1/e of it at j = K
    let soil = Soil {
        cohesion_pa: 500.0,
        ..sand()
    };
    let law = ShearDisplacement::new(0.012);
    let tau = |j: f64| ring::shear_stress(&soil, &law, 2e4, j).unwrap();
    assert!((tau(0.012) - 12_047.005_383_792_515 * 0.632_120_558_828_557_7).abs() < 1e-8);
    assert!(tau(0.0).abs() < f64::MIN_POSITIVE);
    assert!((tau(1.0) - 12_047.005_383_792_515).abs() < 1e-8);
    let at_once = ShearDisplacement::new(0.0);
    assert!((ring::shear_stress(&soil, &at_once, 2e4, 1e-9).unwrap() - 12_047.005_383_792_515).abs() < 1e-8);
}

#[test]
fn torque_of_a_ring_is_the_moment_of_its_stress_and_back() {
    let ring = ring(0.08, 0.11).unwrap();
    // Midpoint sum of tau · 2 π r² dr at 10 kPa.
    let slices = 20_000;
    let dr = 0.03 / f64::from(slices);
    let moment: f64 = (0..slices)
        .map(|i| 0.08 + (f64::from(i) + 0.5) * dr)
        .map(|r| 1e4 * 2.0 * core::f64::consts::PI * r * r * dr)
        .sum();
    assert!((ring.torque_n_m(1e4) / moment - 1.0).abs() < 1e-8);
    for tau in [1.0, 3.7e3, 4.2e4] {
        assert!((ring.shear_stress_pa(ring.torque_n_m(tau)) / tau - 1.0).abs() < 1e-15);
    }
    // One radian at the mean radius of 95 mm.
    assert!((ring.displacement_m(1.0) - 0.095).abs() < 1e-16);
    assert!((ring.angle_rad(ring.displacement_m(0.7)) - 0.7).abs() < 1e-15);
}

#[test]
fn a_plate_too_small_for_a_negative_k_c_is_rejected_by_its_modulus() {
    // k_c = −5e5 under 40 mm: k* = 1e7 − 1.25e7 < 0; under 60 mm it is 1.67e6
    let soil = Soil { k_c: -5e5, ..sand() };
    let rejection = plate::pressure(&soil, &SMALL, 0.006).unwrap_err();
    let expected = "invalid parameter: k_star = -2500000 N/m^(n+2) must be above 0 under the plate";
    assert_eq!(rejection.to_string(), expected);
    assert!(plate::pressure(&soil, &Plate::Circle { radius_m: 0.06 }, 0.006).unwrap() > 0.0);
}

#[test]
fn arguments_outside_their_bounds_are_rejected_by_name() {
    let named = |rejected: Result<f64, Rejection>, expected: &str| match rejected {
        Err(Rejection::InvalidParameter { name, .. }) => assert_eq!(name, expected),
        other => panic!("{other:?}"),
    };
    let law = ShearDisplacement::new(0.01);
    let flat = Plate::Circle { radius_m: 0.0 };
    named(plate::pressure(&sand(), &SMALL, -1e-3), "sinkage_m");
    named(plate::pressure(&sand(), &flat, 1e-3), "plate_width_m");
    let stress = |normal: f64, displacement: f64| ring::shear_stress(&sand(), &law, normal, displacement);
    named(stress(f64::NAN, 0.01), "normal_stress_pa");
    named(stress(1e4, -0.01), "shear_displacement_m");
    assert!(ring(0.1, 0.1).is_err());
}
