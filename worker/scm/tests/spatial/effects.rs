//! Effects on the wheel in three dimensions: neutral effects, formulas, mechanisms, measured channels, refusals.

use super::surfaces::{Surface, across};
use crate::scene::{Track, bars, grousered, smooth};
use crate::support::law;
use formula::Effect;
use scm::spatial::{Displacement, Shape, SpatialRun};
use scm::{Averages, Rejection};

/// Returns an effect with one dimensionless parameter `a` and these formulas.
fn effect(formulas: &str) -> Effect {
    let text = format!(
        "name = \"trial\"\nsummary = \"for a test\"\nsource = \"none\"\n{formulas}\n\
         [parameters.a]\nunit = \"1\"\nneutral = 0\nprior = {{ half_normal = 1.0 }}\n"
    );
    Effect::read(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Returns a short run on a coarse grid.
fn short(mut track: Track) -> Track {
    track.settings.dem_spacing_m = 0.008;
    track.settings.travel_step_m = 0.002;
    track.for_a_travel_of(0.12, 0.04)
}

fn short_smooth() -> Track {
    short(smooth(0.2, 100.0, 30.0))
}

fn short_with_grousers() -> Track {
    short(grousered(0.2))
}

/// Returns a smooth wheel of 45 facets, a model of which keeps lanes apart.
fn short_mesh() -> Track {
    let mut track = short_smooth();
    track.shape = Shape::from(Surface::default().rim(0.125, 45, &across(0.112, 14), |_| 1.0).0);
    track
}

fn rejection(track: &Track) -> Rejection {
    track.try_roll().expect_err("a rejection")
}

#[track_caller]
fn assert_invalid(track: &Track, what: &str) {
    let message = rejection(track).to_string();
    assert!(
        message.starts_with(&format!("invalid parameter: {what}")),
        "{message}"
    );
}

/// Greatest relative difference of two runs, over all steps and channels.
fn difference(a: &SpatialRun, b: &SpatialRun) -> f64 {
    assert_eq!(a.history.len(), b.history.len());
    let channels = a.history.channels().into_iter().zip(b.history.channels());
    channels.fold(0.0_f64, |largest, (a, b)| {
        let scale = a
            .iter()
            .fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()));
        let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs() / scale);
        largest.max(differences.fold(0.0, f64::max))
    })
}

#[test]
fn neutral_effects_are_none_bit_for_bit() {
    for track in [short_smooth(), short_with_grousers()] {
        let base = track.roll();
        for effect in formula::catalogue::catalogue() {
            let mut with = track.clone();
            with.enter(effect, &neutral(effect));
            assert_eq!(with.roll(), base, "{}", effect.name);
        }
    }
}

/// Strengths at their neutral values, other parameters at typical values.
fn neutral(effect: &Effect) -> Vec<f64> {
    let values = effect.parameters.iter().zip(typical(effect));
    values
        .map(|(parameter, typical)| parameter.neutral.unwrap_or(typical))
        .collect()
}

/// Returns the values at which tables show an effect.
pub(super) fn typical(effect: &Effect) -> Vec<f64> {
    let values = effect.parameters.iter().map(|parameter| {
        let fixed = parameter.prior.as_float();
        let value = parameter.typical.or(fixed).or(parameter.neutral);
        value.unwrap_or_else(|| panic!("{}: no typical {}", effect.name, parameter.name))
    });
    values.collect()
}

#[test]
fn formulas_equal_to_the_base_laws_give_the_base() {
    // the last formula alone only scales the stress; all together it is computed at every trial height
    let all = "pressure = \"p * (1 + a) / 2\"\nshear_limit = \"(cohesion_pa + p * tan(friction_angle_rad)) * a\"\n\
               shear = \"tau_max * (1 - exp(-v_t / 0.001)) * a\"";
    for formulas in ["shear = \"tau * (1 - exp(-v_t / 0.001)) * a\"", all] {
        for k_c in [0.0, 1e5] {
            for slip_angle_deg in [0.0_f64, 10.0] {
                for track in [short_smooth(), short_with_grousers(), short_mesh()] {
                    let mut track = track;
                    // fine enough that the contact, which v0 lengthens slightly, does not refine it
                    track.settings.dem_spacing_m = 0.004;
                    track.case.soil.k_c = k_c;
                    track.case.soil.cohesion_pa = 200.0;
                    track.case.condition.slip_angle_rad = slip_angle_deg.to_radians();
                    let base = track.roll();
                    track.case.soil.shear_velocity_m_s = 0.0;
                    track.enter(&effect(formulas), &[1.0]);
                    let off = difference(&base, &track.roll());
                    assert!(off < 1e-9, "{formulas}: {off:e}");
                }
            }
        }
    }
}

#[test]
fn a_stress_scaled_once_is_the_stress_scaled_at_every_height() {
    // min() hides that the formula only scales
    for keeper in [Displacement::Rim, Displacement::Node] {
        let mut once = short_with_grousers();
        once.settings.displacement = keeper;
        let mut always = once.clone();
        once.enter(&effect("shear = \"tau * (1 - a * exp(-j / 0.01))\""), &[1.0]);
        let hidden = effect("shear = \"min(tau, 1e9) * (1 - a * exp(-j / 0.01))\"");
        always.enter(&hidden, &[1.0]);
        let off = difference(&once.roll(), &always.roll());
        assert!(off < 1e-9, "{keeper:?}: {off:e}");
    }
}

#[test]
fn formulas_see_the_nodes_they_stand_for() {
    // each formula is a rule for a variable at every loaded node: a violation gives NaN and is refused
    for rule in [
        "position >= 0 and position <= 1",
        "z > 0 and z < 0.05",
        "v_n >= 0 and v_n < 0.02",
        "v_t > 0 and v_t < 0.02",
        "j >= 0 and j < 0.1",
        "b_eff > 0.000001 and b_eff < 0.06",
        "abs(k_star / 1e7 - 1) < 1e-9",
        "contact_length > 0.001 and contact_length < 0.2",
        "p > 0 and abs(tau_max / p / tan(friction_angle_rad) - 1) < 1e-9",
        "tau > 0 and tau < tau_max",
        "pass == 1",
    ] {
        let (first, second) = rule.split_once(" and ").unwrap_or((rule, rule));
        for track in [short_smooth(), short_with_grousers(), short_mesh()] {
            let mut track = track;
            let kept = format!("shear = \"tau * if({first}, if({second}, a, log(-1)), log(-1))\"");
            track.enter(&effect(&kept), &[1.0]);
            let run = track.try_roll();
            assert!(run.is_ok(), "{rule}: {run:?}");
        }
    }
}

#[test]
fn an_inadmissible_value_is_refused_with_its_name_and_inputs() {
    for (formulas, quantity) in [
        ("pressure = \"p * log(-a)\"", "pressure is NaN Pa"),
        ("shear_limit = \"tau_max - a * 1e6\"", "shear_limit is -"),
        ("shear = \"tau * log(-a)\"", "shear is NaN Pa"),
        ("shear = \"tau_max * log(-a)\"", "shear is NaN Pa"),
        ("slip = \"slip + a\"", "slip is 1.2"),
        ("wheel_load = \"wheel_load * (1 - a)\"", "wheel_load is 0 N"),
        (
            "wheel_load = \"wheel_load - a * 1e2 * drawbar_pull\"",
            "wheel_load is -",
        ),
        ("torque = \"torque * log(-a)\"", "torque is NaN N m"),
    ] {
        let mut track = short_smooth();
        track.enter(&effect(formulas), &[1.0]);
        let refused = rejection(&track);
        assert_eq!(refused.kind(), "formula", "{refused}");
        let (message, begin) = (refused.to_string(), format!("effect trial: {quantity}"));
        assert!(
            message.starts_with(&begin) && message.contains("a = 1"),
            "{message}"
        );
    }
}

#[test]
fn a_load_that_follows_the_pull_is_the_one_that_is_carried() {
    let mut track = smooth(0.2, 100.0, 30.0);
    track.enter_named("load_transfer", &[0.15]);
    let run = track.roll();
    let (loads, pulls) = (&run.history.wheel_load_n, &run.history.drawbar_pull_n);
    let mut surplus = loads[0] - 100.0;
    assert!(surplus.abs() < 1.5, "the nominal one at first: {}", loads[0]);
    for step in 1..loads.len() {
        let expected = 100.0 - 0.15 * pulls[step - 1];
        // the residuals of steps, 1.5 % at most, do not accumulate
        surplus += loads[step] - expected;
        assert!(surplus.abs() < 1.5, "{step}: {}, {surplus} so far", loads[step]);
    }
}

#[test]
fn measured_channels_enter_only_histories_and_averages() {
    let track = smooth(0.2, 100.0, 30.0);
    let base = track.roll();
    let mut measured = track.clone();
    measured.enter_named("sled_tare", &[3.0]);
    measured.enter_named("torque_gain", &[0.05]);
    measured.enter_named("sinkage_offset", &[0.002]);
    // a sensor error so large that the soil would seem to give power
    measured.enter_named("drawbar_pull_gain", &[1.0]);
    let run = measured.roll();
    assert!((run.dissipated_power_w / base.dissipated_power_w - 1.0).abs() < 0.02);
    assert_eq!(run.history.wheel_load_n[..50], base.history.wheel_load_n[..50]);
    for step in 0..50 {
        let (got, soil) = (&run.history, &base.history);
        let pull = 2.0 * (soil.drawbar_pull_n[step] - 3.0);
        assert!((got.drawbar_pull_n[step] - pull).abs() < 1e-9);
        assert!((got.torque_n_m[step] - 1.05 * soil.torque_n_m[step]).abs() < 1e-9);
        assert!((got.sinkage_m[step] - soil.sinkage_m[step] - 0.002).abs() < 1e-12);
    }
}

#[test]
fn rebound_is_a_softer_elastic_line() {
    let mut track = short_smooth();
    let mut softer = track.clone();
    softer.ground.elastic_stiffness_pa_m = 1.0 / (1.0 / 1e9 + 5e-8);
    track.enter_named("elastic_rebound", &[5e-8]);
    assert_eq!(track.roll(), softer.roll());
}

#[test]
fn a_flattened_rim_is_as_long_as_its_chord_and_a_mesh_has_none() {
    let mut track = smooth(0.2, 100.0, 30.0);
    let rigid = track.averages();
    track.enter_named("wheel_flexibility", &[5e-5]);
    let flat = track.averages();
    // half the chord of a circle of 125 mm cut off by 5 mm is 35 mm long
    assert!(flat.contact_length_m > 0.035, "{flat:?}");
    assert!(flat.sinkage_m < 0.5 * rigid.sinkage_m, "{flat:?}");
    track.shape = short_mesh().shape;
    assert_invalid(
        &track,
        "deflection_m_n = 0.00005 m/N must be 0 for a wheel given as a mesh",
    );
    track.effects.clear();
    track.enter_named("edge_loss", &[0.005]);
    assert_invalid(&track, "width_m = 0.102");
}

#[test]
fn grousers_on_a_flattened_rim_are_pushed_in_with_it() {
    let mut track = short_with_grousers();
    let rigid = track.averages();
    track.enter_named("wheel_flexibility", &[5e-5]);
    let flat = track.averages();
    assert!((-0.009..rigid.sinkage_m).contains(&flat.sinkage_m), "{flat:?}");
}

#[test]
fn digging_deepens_the_rut_with_slip_and_from_pass_to_pass() {
    let deeper = |slip: f64, pass: u32| {
        let mut track = smooth(slip, 100.0, 30.0);
        track.case.condition.pass = pass;
        track.end_steady(0.005, 0.3);
        let base = track.averages().sinkage_m;
        track.enter_named("slip_digging", &[0.01]);
        track.averages().sinkage_m - base
    };
    let [low, middle, high] = [0.05, 0.2, 0.6].map(|slip| deeper(slip, 1));
    assert!(
        low > 0.0 && middle > 3.0 * low && high > 3.0 * middle,
        "{low} {middle} {high}"
    );
    assert!(deeper(0.2, 2) > 1.5 * middle, "what was dug stays dug");
}

#[test]
fn soil_is_stiffer_near_the_ends_of_its_bin() {
    let mut track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.7, 0.1);
    let base = track.roll().history;
    track.enter_named("end_wall", &[0.3, 0.1]);
    assert_invalid(&track, "bin_length_m = NaN m must be known");
    track.site.bin_length_m = Some(0.95);
    let walls = track.roll().history;
    // the settled wheel sinks less at either end than in the middle
    let lifted = |place: f64| {
        let step = (place * (base.len() - 1) as f64) as usize;
        base.sinkage_m[step] - walls.sinkage_m[step]
    };
    let [rear, middle, front] = [0.05, 0.5, 1.0].map(lifted);
    assert!(middle < 3e-5, "{middle}");
    assert!(
        rear > 2.0 * middle && front > 4.0 * middle,
        "{rear} {middle} {front}"
    );
    track.site.bin_length_m = Some(0.9);
    assert_invalid(&track, "bin_length_m = 0.9 m must be long enough");
}

#[test]
fn formulas_see_the_number_of_every_pass() {
    let mut track = smooth(0.2, 100.0, 30.0);
    track.case.condition.pass = 2;
    track.end_steady(0.005, 0.3);
    let base = track.averages();
    track.enter_named("multipass_hardening", &[0.3]);
    let harder = track.averages();
    assert!(harder.sinkage_m < base.sinkage_m - 1e-4, "{harder:?} {base:?}");
    track.case.condition.pass = 1;
    let mut first = track.clone();
    first.effects.clear();
    assert!((track.averages().sinkage_m - first.averages().sinkage_m).abs() < 1e-12);
}

#[test]
fn all_effects_at_once_are_finite_and_repeat() {
    for grousers in [false, true] {
        let mut track = short_smooth();
        if grousers {
            track.shape = Shape::Rim(bars(12, 0.009, 0.002));
        }
        track.site.density_kg_m3 = Some(1400.0);
        track.site.bin_length_m = Some(2.0);
        track.site.order = Some(0.5);
        for effect in formula::catalogue::catalogue() {
            track.enter(effect, &typical(effect));
        }
        let run = track.roll();
        assert_eq!(run, track.roll());
        assert!(run.history.channels().concat().iter().all(|x| x.is_finite()));
    }
}

#[test]
fn formulas_see_the_slip_across_the_heading() {
    let mut track = short_smooth();
    track.case.condition.slip_angle_rad = 10_f64.to_radians();
    track.enter(&law("lateral_force = \"wheel_load * lateral_slip\""), &[]);
    let condition = track.case.condition;
    let lateral_slip = formula::slip::variables(condition.slip, condition.slip_angle_rad)[3].1;
    let expected = condition.wheel_load_n * lateral_slip;
    assert!((track.roll().averages.lateral_force_n - expected).abs() < 1e-9);
}

#[test]
fn a_measurement_offset_moves_no_soil() {
    // 10 degrees of slip angle and a light load settle late
    let mut track = smooth(0.4, 60.0, 30.0);
    track.case.condition.slip_angle_rad = 10_f64.to_radians();
    let without = track.roll().averages;
    for offset in [1e-3, -without.sinkage_m] {
        let mut with = track.clone();
        with.enter_named("sinkage_offset", &[offset]);
        let with = with.roll().averages;
        let bits =
            |averages: &Averages| [averages.drawbar_pull_n, averages.simulated_travel_m].map(f64::to_bits);
        assert_eq!(bits(&with), bits(&without));
    }
}

#[test]
fn a_sinkage_exponent_beyond_its_bound_is_refused() {
    let mut track = short_smooth();
    track.enter_named("slip_sinkage", &[1e6]);
    assert_eq!(rejection(&track).kind(), "formula");
}

#[test]
fn a_hardened_track_stiffens_from_the_second_pass_on() {
    let mut track = short_smooth();
    track.case.condition.pass = 2;
    let without = track.roll().averages;
    track.enter_named("multipass_hardening", &[0.3]);
    assert!(track.roll().averages.sinkage_m < without.sinkage_m);
}
