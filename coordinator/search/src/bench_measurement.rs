//! Bench measurements: tests without a rolling wheel, and the effects that each decides.

use std::collections::BTreeSet;

use job::PlainParameter;
use record::Verdict;

use super::candidate::candidate_of;

/// A test and the effects that it measures separately.
struct RigTest {
    what: &'static str,
    decides: &'static [&'static str],
}

const TESTS: [RigTest; 7] = [
    RigTest {
        what: "tare run: move the sled without soil under the wheel; the force sensor then shows the rig's own force",
        decides: &["sled_tare", "sled_drag", "bulldozing", "bin_slope", "end_wall"],
    },
    RigTest {
        what: "free-spin run: turn the wheel in the air; the torque sensor then shows the bearing's torque",
        decides: &["bearing_torque", "bearing_friction"],
    },
    RigTest {
        what: "static calibration of the sensors with weights: gains of pull and torque, the load at the wheel",
        decides: &[
            "drawbar_pull_gain",
            "torque_gain",
            "load_scale",
            "load_transfer",
            "sinkage_offset",
        ],
    },
    RigTest {
        what: "ring-shear test in the same soil: friction angle, cohesion and the displacement that mobilises them",
        decides: &[
            "janosi_hanamoto",
            "interface_friction",
            "cohesion_pa",
            "adhesion",
            "friction_rate_weakening",
            "stress_dependent_friction",
        ],
    },
    RigTest {
        what: "run of a rough wheel (glue soil to the rim): rim-soil friction becomes soil-soil friction",
        decides: &["interface_friction", "stick_slip", "adhesion"],
    },
    RigTest {
        what: "the radius that the rig's encoder uses, and the flattening of the rim under load",
        decides: &["slip_radius_error", "wheel_flexibility"],
    },
    RigTest {
        what: "radius and width of the wheel by a caliper, over the rim and over the grousers",
        decides: &["wheel_radius_error", "wheel_width_error"],
    },
];

/// Returns the line of a job with a test's result for an effect's strength.
fn prior_line(effect: &str) -> Option<String> {
    if let Some(plain) = PlainParameter::find(effect) {
        return Some(format!("{} = {{ normal = [VALUE, SD] }}", plain.name));
    }
    let effect = formula::catalogue::find(effect)?;
    let strength = effect.parameters.iter().find(|p| p.neutral.is_some())?;
    Some(format!(
        "\"{}.{}\" = {{ normal = [VALUE, SD] }}",
        effect.name, strength.name
    ))
}

/// Describes the tests that distinguish open explanations; none if one is named.
pub(super) fn deciding(open: &[&str], verdict: Verdict) -> Vec<String> {
    if matches!(verdict, Verdict::Named | Verdict::NothingDetectable) {
        return Vec::new();
    }
    let effect = |name: &&str| match candidate_of(name) {
        Some((effect, _)) => effect.name.clone(),
        None => (*name).to_owned(),
    };
    let open: Vec<String> = open.iter().map(effect).collect();
    let proposal = |test: &RigTest| {
        let decided = open.iter().filter(|name| test.decides.contains(&name.as_str()));
        let lines: BTreeSet<String> = decided.filter_map(|name| prior_line(name)).collect();
        let lines: Vec<String> = lines.into_iter().collect();
        (!lines.is_empty()).then(|| {
            format!(
                "{}. Its result goes under [priors]: {}",
                test.what,
                lines.join(", ")
            )
        })
    };
    TESTS.iter().filter_map(proposal).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_test_measures_effects_of_the_catalogue() {
        for name in TESTS.iter().flat_map(|test| test.decides) {
            assert!(prior_line(name).is_some(), "{name}");
        }
    }

    #[test]
    fn a_test_is_proposed_for_open_effects_only() {
        let open = ["sled_tare", "bulldozing.smooth"];
        let tests = deciding(&open, Verdict::Undecided);
        assert_eq!(tests.len(), 1);
        assert!(tests[0].starts_with("tare run"), "{tests:?}");
        assert!(
            tests[0].contains("\"sled_tare.tare_n\" = { normal = [VALUE, SD] }"),
            "{tests:?}"
        );
        assert!(deciding(&open, Verdict::Named).is_empty());
        assert!(deciding(&["slip_sinkage"], Verdict::Class).is_empty());
    }
}
