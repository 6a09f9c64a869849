//! Forward runs of a bevameter that `worker simulate` refuses.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{run, worker};
use farm_tests::workspace::data;

use super::{PLATES, SHEAR};

/// Returns the refusal of `worker simulate` for a job, which leaves no table behind.
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
    assert_contains!(nothing, "--out", "--plates", "--shear");
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
    // With k_c = −1e9 the soil does not support a plate of 40 mm.
    let lines = theta.lines().filter(|line| !line.starts_with("k_c"));
    let stiff: String = lines.map(|line| format!("{line}\n")).collect();
    let message = simulate(both(), &(stiff + "k_c = -1e9\n"), &["plates", "shear"]);
    assert!(
        message.starts_with("test p1: the model rejects these parameters: invalid parameter: k_star = -")
            && message.ends_with("must be above 0 under the plate"),
        "{message}"
    );
}
