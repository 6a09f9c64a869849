//! Wrong bevameter readings, through `check`, `run` and `worker simulate`.

use farm_tests::job::Job;
use farm_tests::programs::{run, worker};
use farm_tests::workspace::data;

use super::{PLATES, SHEAR, refusal, refused};

/// The small job with a file of readings, changed in one place.
fn with(key: &str, good: &str, old: &str, new: &str) -> Job {
    assert_eq!(good.matches(old).count(), 1, "{old:?} in\n{good}");
    let small = Job::small();
    let experiment = format!("{key} = \"{key}.csv\"\n{}", small.experiment);
    Job { experiment, ..small }.beside(&format!("{key}.csv"), good.replacen(old, new, 1))
}

#[test]
fn malformed_readings_name_file_line_value_unit_and_bound() {
    let plates = |old: &str, new: &str| with("plates", PLATES, old, new);
    let shear = |old: &str, new: &str| with("shear", SHEAR, old, new);
    refused(
        plates("plate_radius_m", "plate_radius"),
        "plates.csv line 1: unknown column \"plate_radius\"; the nearest known is \"plate_radius_m\"",
    );
    refused(
        plates("p1,0.04,0.002", "p1,40,0.002"),
        "plates.csv line 2: plate_radius_m 40 m must be at most 1 m: was it typed in mm (0.04 m) or cm (0.4 m)?",
    );
    refused(
        plates("0.006,", "-0.006,"),
        "plates.csv line 3: sinkage_m -0.006 m must be >= 0 m",
    );
    refused(
        plates("9000", "nine"),
        "plates.csv line 2: pressure_pa \"nine\" is not a number",
    );
    refused(
        shear("20000", "-20000"),
        "shear.csv line 2: normal_stress_pa -20000 Pa must be >= 0 Pa",
    );
    refused(
        shear("0.012", "12"),
        "shear.csv line 2: shear_displacement_m 12 m must be <= 10 m: metres are expected, were these millimetres?",
    );
    refused(
        shear("\nr1,20000,0.012,", ""),
        "shear.csv: the file has no reading of a ring",
    );
}

#[test]
fn readings_that_are_named_but_not_there_are_missed() {
    let small = Job::small();
    let experiment = format!("plates = \"plates.csv\"\n{}", small.experiment);
    let message = refusal(&Job { experiment, ..small });
    assert!(
        message.starts_with("plates.csv: there is no such file"),
        "{message}"
    );
}

/// The message of `worker simulate` on the small job with plates and shear; no table is left behind.
#[track_caller]
fn simulate(job: Job, theta: &str, tables: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    job.beside("theta.toml", theta).write(folder.path());
    let mut command = worker(["simulate", &path("experiment.toml")]);
    command.args([
        "--model",
        &data("nothing-hidden/model.toml").display().to_string(),
    ]);
    command.args(["--parameters", &path("theta.toml")]);
    for table in tables {
        command.args([format!("--{table}"), path(&format!("out.{table}"))]);
    }
    let message = run(command).refusal();
    for table in tables {
        assert!(!folder.path().join(format!("out.{table}")).exists(), "{message}");
    }
    message.replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn forward_runs_refuse_tables_and_parameters_that_they_cannot_give() {
    let theta = farm_tests::workspace::text(&data("nothing-hidden/parameters.toml"));
    let both = || {
        let small = Job::small();
        let experiment = format!(
            "plates = \"plates.csv\"\nshear = \"shear.csv\"\n{}",
            small.experiment
        );
        Job { experiment, ..small }
            .beside("plates.csv", PLATES)
            .beside("shear.csv", SHEAR)
    };
    let nothing = simulate(both(), &theta, &[]);
    for flag in ["--out", "--plates", "--shear"] {
        assert!(nothing.contains(flag), "{nothing}");
    }
    assert_eq!(
        simulate(Job::small(), &theta, &["out", "plates"]),
        "experiment.toml: --plates: the experiment names no plates: add plates = \"plates.csv\""
    );
    let with_modulus = |k: &str| format!("{theta}\n\"janosi_hanamoto.shear_modulus_m\" = {k}\n");
    assert_eq!(
        simulate(both(), &with_modulus("0.01").replace('"', ""), &["shear"]),
        "theta.toml: write the name in quotes: \"janosi_hanamoto.shear_modulus_m\""
    );
    assert_eq!(
        simulate(both(), &with_modulus("-0.01"), &["shear"]),
        "theta.toml: janosi_hanamoto.shear_modulus_m = -0.01 m lies outside [0, inf] m"
    );
    // k_c = −1e9 leaves a plate of 40 mm without support.
    let lines = theta.lines().filter(|line| !line.starts_with("k_c"));
    let stiff: String = lines.map(|line| format!("{line}\n")).collect();
    let message = simulate(both(), &(stiff + "k_c = -1e9\n"), &["plates", "shear"]);
    assert!(
        message.starts_with("test p1: the model rejects these parameters: invalid parameter: k_star = -")
            && message.ends_with("must be above 0 under the plate"),
        "{message}"
    );
}

#[test]
fn readings_that_cannot_be_data_are_refused() {
    let zero = PLATES.replace("9000", "0");
    refused(
        with("plates", &zero, "p1,0.04,0.006,", "p1,0.04,0.006,1"),
        "experiment.toml: test \"p1\": pressure_pa 0 Pa at sinkage_m 0.002 m has no logarithm: both must be > 0, or leave the reading blank",
    );
    let ring = SHEAR.replace("0.012,", "0.012,9000");
    let job = || with("shear", &ring, "9000", "9000.0");
    refused(
        job().in_job("kappa = 0.0", "kappa = 0.0\nbevameter.ln_transfer = 0.0"),
        "job.toml line 10: write the name in quotes: \"bevameter.ln_transfer\"",
    );
    refused(
        Job::small().in_job("kappa = 0.0", "kappa = 0.0\n\"bevameter.ln_transfer\" = 0.0"),
        "job.toml: bevameter.ln_transfer is given, but the experiment has no measured reading of a ring",
    );
    refused(
        job().in_job(
            "kappa = 0.0",
            "kappa = 0.0\n\"janosi_hanamoto.shear_modulus_m.w\" = { lognormal = [0.008, 2.5] }",
        ),
        "job.toml: janosi_hanamoto.shear_modulus_m.w belongs to one wheel: a ring feels janosi_hanamoto.shear_modulus_m, which all share",
    );
}
