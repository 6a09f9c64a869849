//! Values of formulas that the model cannot use.

use formula::Effect;
use formula::catalogue::find;
use scm::effects::{CompiledEffects, ModelForm, Site};
use scm::{Averages, Rejection};

use crate::support::{base, compiled, law};
use crate::validation::effects::{SITE, values, with_effect};

fn with_law(hook: &str, formula: &str, slip: f64) -> Result<Averages, Rejection> {
    let effects = compiled([&law(&format!("{hook} = \"{formula}\""))]);
    base(slip, 100.0, 30.0).simulate_with(&mut effects.activate([vec![]]), &Site::default())
}

#[test]
fn a_value_that_is_no_number_is_refused_with_effect_and_values() {
    let rejection = with_law("pressure", "p * (z / 0 - z / 0)", 0.2).unwrap_err();
    assert_eq!(rejection.kind(), "formula");
    let message = rejection.to_string();
    let begin = "effect odd: pressure is NaN Pa, which must be finite and at least 0 (p = ";
    assert!(
        message.starts_with(begin) && message.contains("z = "),
        "{message}"
    );
    // the message shows the inputs of the formula
    assert!(!message.contains("p = NaN"), "{message}");
}

#[test]
fn every_hook_has_its_bound() {
    for (hook, formula, says) in [
        ("slip", "1.5", "slip is 1.5, which must be in [-1, 1)"),
        (
            "radius",
            "-radius",
            "is -0.125 m, which must be finite and above 0",
        ),
        ("wheel_load", "wheel_load - 200", "wheel_load is -100 N"),
        ("wheel_load", "wheel_load - 1e3 * drawbar_pull", "wheel_load is -"),
        ("sinkage_exponent", "n - 2", "sinkage_exponent is -"),
        ("sinkage_exponent", "n + 20", "must be above 0 and at most 10"),
        ("pressure", "-p", "pressure is -"),
        ("shear_limit", "tau_max / 0", "shear_limit is inf Pa"),
        ("shear", "-tau", "shear is -"),
        (
            "torque",
            "log(slip - 1)",
            "is NaN N m, which must be finite (slip = 0.2)",
        ),
        ("drawbar_pull", "drawbar_pull * density_kg_m3", "is NaN N"),
    ] {
        let refused = with_law(hook, &format!("1 * ({formula})"), 0.2).unwrap_err();
        let message = refused.to_string();
        assert!(
            message.starts_with(&format!("effect odd: {hook} is ")),
            "{message}"
        );
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
    let effects = compiled(find("wheel_flexibility"));
    let refused = base(0.2, 100.0, 30.0).simulate_with(&mut effects.activate([vec![2e-3]]), &SITE);
    let expected = "invalid parameter: deflection of the rim = 0.2 m must be at least 0 and below the radius";
    assert_eq!(refused.unwrap_err().to_string(), expected);
}

#[test]
fn a_flattened_rim_has_a_balance_at_any_kappa() {
    let effects = compiled(find("wheel_flexibility"));
    let sinkage_mm = |kappa: f64| {
        let mut case = base(0.2, 60.0, 30.0);
        (case.soil.k_c, case.soil.k_phi) = scm::bekker_moduli(5.0, kappa, case.soil.n);
        let run = case.simulate_with(&mut effects.activate([vec![7.5e-5]]), &SITE);
        let run = run.unwrap_or_else(|rejection| panic!("kappa {kappa}: {rejection}"));
        assert!(run.residual_load_n.abs() < 1e-6, "kappa {kappa}: {run:?}");
        1e3 * run.sinkage_m
    };
    let plain = sinkage_mm(0.0);
    assert!((plain - 0.974).abs() < 1e-3, "{plain}");
    for kappa in [1e-9, -1e-9] {
        assert!((sinkage_mm(kappa) - plain).abs() < 1e-6, "kappa {kappa}");
    }
    // the footprint of 36 mm is wider than the reference width, so k* falls with kappa
    let sinkages = [-0.4, -0.1, 0.01, 0.5].map(sinkage_mm);
    assert!(sinkages.is_sorted(), "{sinkages:?}");
}

#[test]
fn jumps_of_a_law_leave_forces_continuous() {
    // a jump at a depth that moves in small steps across the nodes of the quadrature
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

#[test]
fn channels_see_the_load_that_is_carried() {
    let bearing = |strengths: &[(&str, &str, f64)]| {
        let named = strengths
            .iter()
            .chain(&[("bearing_friction", "friction_arm_m", 0.01)]);
        let (effects, given): (Vec<&Effect>, Vec<Vec<f64>>) = named
            .map(|(name, strength, value)| {
                let effect = find(name).expect("in the catalogue");
                (effect, values(effect, strength, *value))
            })
            .unzip();
        let compiled = compiled(effects);
        let case = base(0.2, 100.0, 30.0);
        let run = |values: Vec<Vec<f64>>| {
            case.simulate_with(&mut compiled.activate(values), &SITE)
                .expect("support")
        };
        let mut idle = given.clone();
        *idle.last_mut().expect("bearing friction") = vec![0.0];
        let (with, without) = (run(given), run(idle));
        (with.torque_n_m - without.torque_n_m, without.drawbar_pull_n)
    };
    let (scaled, _) = bearing(&[("load_scale", "load_error", 0.2)]);
    assert!((scaled - 1.2).abs() < 1e-9, "{scaled}");
    // the result is unchanged if another effect depends on the pull, however weakly
    let weak = ("load_transfer", "transferred_share", 1e-9);
    let (both, _) = bearing(&[("load_scale", "load_error", 0.2), weak]);
    assert!((both - 1.2).abs() < 1e-6, "{both}");
    let (transferred, pull) = bearing(&[("load_transfer", "transferred_share", 0.3)]);
    let expected = 0.01 * (100.0 - 0.3 * pull);
    assert!((transferred - expected).abs() < 1e-9, "{transferred}");
}

#[test]
fn laws_that_jump_with_the_contact_or_the_reaction_have_a_balance() {
    for (hook, formula) in [
        ("pressure", "p * if(contact_length > 0.0365, 1.5, 1)"),
        ("wheel_load", "wheel_load * if(drawbar_pull > 36, 0.7, 1)"),
        ("wheel_load", "wheel_load - 0.1 * max(drawbar_pull - 30, 0)"),
    ] {
        let run = with_law(hook, &format!("1 * ({formula})"), 0.2).unwrap();
        assert!(run.drawbar_pull_n.is_finite() && run.sinkage_m > 0.0, "{run:?}");
    }
}

#[test]
fn a_wheel_that_reads_as_sunk_to_its_hub_is_refused() {
    let effects = compiled(find("slip_digging"));
    let refused = base(0.97, 100.0, 30.0).simulate_with(&mut effects.activate([vec![0.01]]), &SITE);
    let message = refused.unwrap_err().to_string();
    assert!(message.contains("sinkage_m = 0.32"), "{message}");
    assert!(message.contains("below the wheel's radius"), "{message}");
}

#[test]
fn a_mechanism_without_its_parameters_is_refused() {
    let effect = law("mechanism = \"rebound\"");
    let refused = CompiledEffects::compile(ModelForm::QuasiStatic, [&effect]).unwrap_err();
    let expected = "effect odd: mechanism rebound takes the parameters compliance_m_pa, in this order";
    assert_eq!(refused.to_string(), expected);
}
