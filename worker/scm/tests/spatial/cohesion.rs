//! Negative cohesive moduli: the lowest kappa at which a wheel finds a balance.
//!
//! The plates of `examples/cmu-sand` give kappa = `k_c / (k_phi b_ref)` = −0.66 ± 0.03. The modulus k* of a footprint is positive
//! from `b_eff = −kappa b_ref` on: 19.8 mm at −0.66, 28.5 mm at −0.95.

use crate::scene::{Track, bars, grousered};
use crate::support::{assert_near, base};
use scm::Wheel;
use scm::spatial::{Footprint, Shape};

/// Values of kappa in hundredths.
const KAPPAS: [i32; 7] = [0, -30, -40, -50, -66, -80, -95];

/// Grousers (count, height), share that flows, and the last of [`KAPPAS`] with a balance at slip 0.05 and 0.4: with the
/// hull, and with patches.
type Limits = (u32, f64, f64, i32, i32);

/// A wheel of 125 mm by 112 mm under 100 N, on sand of 36 kPa at 10 mm.
const WIDE: [Limits; 8] = [
    (0, 0.0, 0.0, -95, -95),
    (0, 0.0, 0.25, -95, -50),
    (12, 0.005, 0.0, -95, -66),
    (12, 0.005, 0.25, -95, -50),
    (24, 0.005, 0.0, -95, -40),
    (24, 0.005, 0.25, -95, -40),
    (12, 0.009, 0.0, -95, -66),
    (12, 0.009, 0.25, -95, -50),
];

/// The wheel of `examples/cmu-sand`, 58 mm by 50 mm under 24 N, on its sand of 8.5 kPa at 10 mm.
const NARROW: [Limits; 8] = [
    (0, 0.0, 0.0, -80, -80),
    (0, 0.0, 0.25, -80, -40),
    (12, 0.005, 0.0, -80, 0),
    (12, 0.005, 0.25, -80, 0),
    (24, 0.005, 0.0, -80, 0),
    (24, 0.005, 0.25, -80, 0),
    (12, 0.009, 0.0, -80, 0),
    (12, 0.009, 0.25, -80, 0),
];

fn narrow() -> Track {
    let mut case = base(0.05, 24.0, 30.0);
    case.wheel = Wheel {
        radius_m: 0.058,
        width_m: 0.05,
        rig_radius_m: 0.058,
    };
    case.condition.sled_speed_m_s = 0.01;
    case.soil.n = 1.32;
    Track::with_grousers(case)
}

/// Returns the last kappa at which a wheel finds a balance at both slips, on sand of a reference pressure `[log10 Pa]`.
fn limit(wheel: &Track, log10_p_ref: f64, footprint: Footprint) -> Option<i32> {
    let balanced = |kappa: i32| {
        [0.05, 0.4].into_iter().all(|slip| {
            let mut track = wheel.clone();
            let soil = &mut track.case.soil;
            (soil.k_c, soil.k_phi) = scm::bekker_moduli(log10_p_ref, 0.01 * f64::from(kappa), soil.n);
            track.case.condition.slip = slip;
            track.settings.footprint = footprint;
            let kind = track
                .try_roll()
                .map_or_else(|rejection| rejection.kind(), |_| "balanced");
            assert!(
                ["balanced", "no_support", "no_convergence"].contains(&kind),
                "{kind}"
            );
            kind == "balanced"
        })
    };
    KAPPAS.into_iter().take_while(|&kappa| balanced(kappa)).last()
}

fn compare(wheel: &Track, log10_p_ref: f64, table: &[Limits]) {
    let mut wrong = Vec::new();
    for &(count, height_m, flow_fraction, by_hull, by_patches) in table {
        let mut track = wheel.clone();
        track.shape = Shape::Rim(bars(count, height_m, 0.002));
        track.ground.flow_fraction = flow_fraction;
        let limits = [Footprint::Hull, Footprint::Patches].map(|f| limit(&track, log10_p_ref, f));
        if limits != [Some(by_hull), Some(by_patches)] {
            wrong.push((count, height_m, flow_fraction, limits));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn a_wide_wheel_finds_a_balance_down_to_the_kappa_of_its_row() {
    compare(&grousered(0.05), 4.56, &WIDE);
}

#[test]
fn a_narrow_wheel_finds_a_balance_down_to_the_kappa_of_its_row() {
    compare(&narrow(), 3.93, &NARROW);
}

#[test]
fn half_a_wheel_has_the_hull_of_the_whole_and_an_angle_turns_neither() {
    let mut track = narrow();
    let soil = &mut track.case.soil;
    (soil.k_c, soil.k_phi) = scm::bekker_moduli(3.93, -0.66, soil.n);
    let half = track.averages();
    let mut whole = track.clone();
    whole.settings.both_halves = true;
    let mut turned = track.clone();
    turned.case.condition.slip_angle_rad = 1e-3;
    for (name, track, tolerance) in [("whole", whole, 0.01), ("turned", turned, 0.03)] {
        let got = track.averages();
        assert_near(&half, &got, [f64::INFINITY, f64::INFINITY, tolerance]);
        assert!(
            (half.b_eff_m / got.b_eff_m - 1.0).abs() < tolerance,
            "{name}: {got:?}"
        );
    }
}
