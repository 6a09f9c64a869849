//! Wrong effects, through `check` and `run`.

use farm_tests::job::{GAIN, Job};

use super::{refusal, refused};

const MODEL: &str = "shear_velocity_m_s = 0.001";
const KAPPA: &str = "kappa = 0.0";

fn model(line: &str) -> Job {
    Job::small().in_job(MODEL, &format!("{MODEL}\n{line}"))
}

fn priors(line: &str) -> Job {
    Job::small().in_job(KAPPA, &format!("{KAPPA}\n{line}"))
}

/// The small job with an effect file, changed in one place.
#[track_caller]
fn mine(old: &str, new: &str) -> Job {
    assert_eq!(GAIN.matches(old).count(), 1, "{old:?} in\n{GAIN}");
    model("effect_files = [\"mine.toml\"]").beside("mine.toml", GAIN.replacen(old, new, 1))
}

#[test]
fn unknown_effects_and_parameters_name_the_nearest_known() {
    refused(
        model("effects = [\"buldozing\"]"),
        "job.toml: [model] unknown effect \"buldozing\"; the nearest known is \"bulldozing\"",
    );
    refused(
        priors("\"sled_tar.tare_n\" = 0.0"),
        "job.toml line 10: unknown effect \"sled_tar\"; the nearest known is \"sled_tare\"",
    );
    refused(
        priors("\"sled_tare.tare\" = 0.0"),
        "job.toml line 10: unknown parameter of effect sled_tare \"tare\"; the nearest known is \"tare_n\"",
    );
    refused(
        priors("\"sled_tare.tare_n.v\" = 0.0"),
        "job.toml line 10: unknown wheel \"v\"; known are w",
    );
    refused(
        model("effects = \"sled_tare\""),
        "job.toml: [model] effects = \"sled_tare\" must be a list of names in quotes",
    );
    refused(
        model("effects = [\"sled_tare\", \"sled_tare\"]"),
        "job.toml: [model] effects: \"sled_tare\" appears twice",
    );
    refused(
        model("effects = [\"mine.toml\"]"),
        "job.toml: [model] effects: \"mine.toml\" looks like a file, which belongs under effect_files",
    );
    refused(
        priors("sled_tare.tare_n = 0.0"),
        "job.toml line 10: write the name in quotes: \"sled_tare.tare_n\"",
    );
    refused(
        model("sled_tare.tare_n = 0.0"),
        "job.toml: [model] write the name in quotes: \"sled_tare.tare_n\"",
    );
}

#[test]
fn what_an_effect_needs_of_the_experiment_is_named() {
    refused(
        model("effects = [\"bulldozing\"]"),
        "job.toml: effect bulldozing needs density_kg_m3 of soil s",
    );
    refused(
        model("effects = [\"end_wall\"]"),
        "job.toml: effect end_wall needs bin_length_m under [rig]",
    );
    refused(
        model("effects = [\"drift_torque_zero\"]"),
        "job.toml: effect drift_torque_zero needs the column order in runs.csv: the number of each run in time",
    );
    refused(
        model("effects = [\"lug_thrust\"]").in_experiment("[soil.s]", "[soil.s]\ndensity_kg_m3 = 1400.0"),
        "job.toml: effect lug_thrust needs a wheel with grousers: w has none",
    );
}

#[test]
fn strengths_that_contradict_each_other_are_refused() {
    refused(
        priors("\"sled_tare.tare_n\" = { normal = [0.0, 1.0] }\n\"sled_tare.tare_n.w\" = 0.0"),
        "job.toml: sled_tare.tare_n is given both for all wheels and for one wheel",
    );
    refused(
        priors("\"bearing_torque.friction_torque_n_m\" = -0.1"),
        "job.toml: bearing_torque.friction_torque_n_m = -0.1 N m lies outside [0, inf] N m",
    );
    let many: Vec<String> = formula::catalogue::catalogue()[..11]
        .iter()
        .map(|effect| format!("{:?}", effect.name))
        .collect();
    refused(
        model(&format!("effects = [{}]", many.join(", "))),
        "job.toml: [model] 11 effects must be at most 10",
    );
}

#[test]
fn malformed_effect_files_name_file_line_and_column() {
    refused(
        mine("gain)", "gian)"),
        "mine.toml line 4, column 37: unknown name \"gian\"; the nearest known is \"gain\"",
    );
    refused(
        mine("neutral", "neutrl"),
        "mine.toml line 7, column 1: unknown key \"neutrl\"; the nearest known is \"neutral\"",
    );
    refused(
        mine("normal", "nromal"),
        "mine.toml line 5: prior of parameter gain: unknown distribution \"nromal\"; the nearest known is \"normal\"",
    );
    refused(
        mine("normal = [0.0, 0.2]", "uniform = [0.8, 0.0]"),
        "mine.toml line 5: prior of parameter gain: lower bound 0.8 is not below upper bound 0",
    );
    refused(
        mine("\"my_gain\"", "\"hard_pan\""),
        "mine.toml line 1: name \"hard_pan\" belongs to an effect of the catalogue",
    );
    refused(
        mine("drawbar_pull = ", "mechanism = \"rebound\"\ndrawbar_pull = "),
        "mine.toml line 4: mechanism is reserved for the catalogue: a file has formulas",
    );
    refused(
        model("effect_files = [\"mine.toml\", \"copy.toml\"]")
            .beside("mine.toml", GAIN)
            .beside("copy.toml", GAIN),
        "copy.toml: effect my_gain is already in mine.toml",
    );
    let message = refusal(&model("effect_files = [\"mine.toml\"]"));
    assert!(
        message.starts_with("mine.toml: there is no such file"),
        "{message}"
    );
}
