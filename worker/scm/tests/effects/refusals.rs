//! What the model cannot use of a formula.

use formula::Effect;
use formula::catalogue::find;
use scm::effects::{Effects, Model, Site};
use scm::{Averages, Rejection, quasi_static};

use crate::support::base;
use crate::validation::effects::{SITE, with_effect};

fn with_law(hook: &str, formula: &str, slip: f64) -> Result<Averages, Rejection> {
    let text =
        format!("name = \"odd\"\nsummary = \"an odd law\"\nsource = \"none\"\n{hook} = \"{formula}\"\n");
    let effect = Effect::read(&text).expect("a formula");
    let effects = Effects::compile(Model::QuasiStatic, [&effect]).expect("a form");
    let case = base(slip, 100.0, 30.0);
    let mut active = effects.activate([vec![]]);
    quasi_static::simulate_with(
        &case.soil,
        &case.wheel,
        &case.condition,
        &mut active,
        &Site::default(),
    )
}

#[test]
fn what_is_no_number_names_the_effect_and_the_values() {
    let rejection = with_law("pressure", "p * (z / 0 - z / 0)", 0.2).unwrap_err();
    assert_eq!(rejection.kind(), "formula");
    let message = rejection.to_string();
    assert!(
        message.starts_with("effect odd: pressure is NaN Pa, which must be finite and at least 0 (p = ")
            && message.contains("z = "),
        "{message}"
    );
}

#[test]
fn every_hook_has_its_bound() {
    for (hook, formula, says) in [
        ("slip", "1.5", "slip is 1.5, which must be in [-1, 1)"),
        (
            "radius",
            "-radius",
            "radius is -0.125 m, which must be finite and above 0",
        ),
        ("wheel_load", "wheel_load - 200", "wheel_load is -100 N"),
        (
            "wheel_load",
            "wheel_load - 1000 * drawbar_pull",
            "wheel_load is -",
        ),
        ("sinkage_exponent", "n - 2", "sinkage_exponent is -"),
        ("pressure", "-p", "pressure is -"),
        ("shear_limit", "tau_max / 0", "shear_limit is inf Pa"),
        ("shear", "-tau", "shear is -"),
        (
            "torque",
            "log(slip - 1)",
            "torque is NaN N m, which must be finite (slip = 0.2)",
        ),
        (
            "drawbar_pull",
            "drawbar_pull * density_kg_m3",
            "drawbar_pull is NaN N",
        ),
    ] {
        let message = with_law(hook, &format!("1 * ({formula})"), 0.2)
            .unwrap_err()
            .to_string();
        assert!(message.contains(says), "{message}");
    }
}

#[test]
fn a_branch_that_is_not_taken_may_be_anything() {
    let with = with_law("shear", "if(slip > 0.5, 1 / 0, tau)", 0.2).unwrap();
    let without = base(0.2, 100.0, 30.0).simulate();
    // a law with branches is integrated with more nodes
    assert!((with.drawbar_pull_n - without.drawbar_pull_n).abs() < 1e-3);
}

#[test]
fn a_deflection_beyond_the_radius_is_refused() {
    let effects = Effects::compile(Model::QuasiStatic, find("wheel_flexibility")).unwrap();
    let case = base(0.2, 100.0, 30.0);
    let mut active = effects.activate([vec![2e-3]]);
    let refused = quasi_static::simulate_with(&case.soil, &case.wheel, &case.condition, &mut active, &SITE);
    assert_eq!(
        refused.unwrap_err().to_string(),
        "invalid parameter: deflection of the rim = 0.2 m must be at least 0 and below the radius"
    );
}

#[test]
fn jumps_of_a_law_leave_forces_continuous() {
    // a step in depth, moved in small steps across the nodes of the quadrature
    let pull = |depth: f64| {
        let run = with_law("pressure", &format!("if(z > {depth:.6}, 1.5 * p, p)"), 0.2).unwrap();
        assert!(run.residual_load_n.abs() < 1e-6, "{run:?}");
        run.drawbar_pull_n
    };
    let pulls: Vec<f64> = (0..200).map(|i| pull(2e-3 + 1e-5 * f64::from(i))).collect();
    let steps = pulls.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let largest = steps.fold(0.0_f64, f64::max);
    assert!(largest < 0.05, "{largest} N for 10 um");
}

#[test]
fn the_load_that_follows_the_pull_is_met() {
    let case = base(0.2, 100.0, 30.0);
    let run = with_effect(&case, "load_transfer", "transferred_share", 0.15, &SITE);
    let mut lighter = case;
    lighter.condition.wheel_load_n = 100.0 - 0.15 * run.drawbar_pull_n;
    assert!((lighter.simulate().drawbar_pull_n - run.drawbar_pull_n).abs() < 1e-6);
}
