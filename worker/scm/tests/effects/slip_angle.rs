//! The slip variables of formulas at a slip angle, and the catalogue's effects there.

use scm::Averages;

use crate::support::{Case, base, compiled, law};
use crate::validation::effects::{SITE, with_effect};

/// Returns the base case at a slip angle.
fn at(slip: f64, degrees: f64) -> Case {
    let mut case = base(slip, 100.0, 30.0);
    case.condition.slip_angle_rad = degrees.to_radians();
    case
}

/// Returns the lateral force with these formulas, where `formula` gives it in newtons.
fn lateral_force_by(formulas: &str, formula: &str, case: &Case) -> f64 {
    let law = law(&format!(
        "{formulas}lateral_force = \"wheel_load / 100 * {formula}\""
    ));
    let effects = compiled([&law]);
    let run = case.simulate_with(&mut effects.activate([Vec::new()]), &SITE);
    run.expect("a balance").lateral_force_n
}

#[test]
fn formulas_see_the_slip_angle_and_both_parts_of_the_slip() {
    // v = 0.8 of the rim's speed, which is the greater: 1 - 0.8 cos 30, and 0.8 sin 30
    for (formula, expected) in [
        ("sin(slip_angle)", 0.5),
        ("slip", 0.2),
        ("longitudinal_slip", 1.0 - 0.8 * 0.75_f64.sqrt()),
        ("lateral_slip", 0.4),
    ] {
        let got = lateral_force_by("", formula, &at(0.2, 30.0));
        assert!((got - expected).abs() < 1e-12, "{formula}: {got}");
    }
}

#[test]
fn a_slip_that_an_effect_changes_changes_both_parts() {
    let got = lateral_force_by("slip = \"slip + 0.3\"\n", "lateral_slip", &at(0.2, 30.0));
    assert!((got - 0.25).abs() < 1e-12, "{got}");
}

fn with(case: &Case, name: &str, strength: &str, value: f64) -> Averages {
    with_effect(case, name, strength, value, &SITE)
}

#[test]
fn the_side_pushes_by_its_passive_resistance() {
    let case = at(0.2, 30.0);
    let plain = case.simulate();
    // 30 degrees: tan(wedge) = 1/sqrt 3, so that both factors are 2 sqrt 3
    let weight = 1400.0 * 9.81 * plain.sinkage_m * plain.sinkage_m / 2.0;
    let wall = plain.contact_length_m * 12.0 * 8.0 / 15.0 * weight;
    let pushed = with(&case, "side_bulldozing", "push_scale", 2.0);
    // sqrt(sin 30 * 0.8 sin 30)
    let expected = 2.0 * wall * 0.5 * 0.8_f64.sqrt();
    assert!((pushed.lateral_force_n - plain.lateral_force_n - expected).abs() < 1e-9);
    let mirrored = with(&at(0.2, -30.0), "side_bulldozing", "push_scale", 2.0);
    assert!((mirrored.lateral_force_n + pushed.lateral_force_n).abs() < 1e-9);
    // longitudinal slip 0.307, below the turning slip of 0.7: the side resists, on either side
    let drag = 2.0 * wall * 0.5 * (0.7 - (1.0 - 0.8 * 0.75_f64.sqrt()));
    for degrees in [30.0, -30.0] {
        let dragged = with(&at(0.2, degrees), "side_drag", "drag_scale", 2.0);
        assert!((plain.drawbar_pull_n - dragged.drawbar_pull_n - drag).abs() < 1e-9);
    }
}

#[test]
fn exponents_follow_skid_and_slip_angle() {
    let equivalent = |case: &Case, added_exponent: f64| {
        let mut case = *case;
        case.soil.n += added_exponent;
        case.simulate()
    };
    for (name, strength, case, added_exponent) in [
        (
            "lateral_slip_sinkage",
            "lateral_exponent",
            at(0.2, 60.0),
            0.4 * 0.5,
        ),
        // a skid of 0.6 is above the turning skid of 0.5, one of 0.2 below it, and driving is no skid
        ("skid_sinkage", "exponent_per_skid", at(-0.6, 0.0), 0.4 * 0.06),
        ("skid_sinkage", "exponent_per_skid", at(-0.2, 0.0), -0.4 * 0.06),
        ("skid_sinkage", "exponent_per_skid", at(0.2, 0.0), 0.0),
        // only the part along the heading counts
        ("slip_sinkage", "exponent_per_slip", at(0.2, 60.0), 0.4 * 0.1),
    ] {
        let got = with(&case, name, strength, 0.4).sinkage_m;
        let expected = equivalent(&case, added_exponent).sinkage_m;
        assert!(
            (got - expected).abs() < 1e-9,
            "{name}: {got} for {expected} in {case:?}"
        );
    }
}

#[test]
fn stretched_mobilisation_starts_faster_and_ends_slower() {
    // shear displacement stays below the modulus at a small slip and exceeds it at a large one
    let pull = |name: &str, slip: f64, modulus: f64| {
        with(&at(slip, 0.0), name, "shear_modulus_m", modulus).drawbar_pull_n
    };
    for (slip, modulus, is_more) in [(0.05, 0.01, true), (0.8, 0.01, false)] {
        let stretched = pull("stretched_mobilisation", slip, modulus);
        let plain = pull("janosi_hanamoto", slip, modulus);
        assert_eq!(stretched > plain, is_more, "slip {slip}: {stretched} {plain}");
    }
}
