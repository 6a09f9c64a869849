//! A reference campaign whose posterior is the prior of the next one: the effect that appears in between is named.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run, worker};
use farm_tests::workspace::{data, text};
use serde_json::Value;

const SAMPLER: &str = "algorithm = \"tmcmc\"\nparticles = 60\nmoves = [2, 4]";
const FIT: &str = "algorithm = \"lm\"";
/// The base model's priors, which the posterior replaces.
const PRIORS: &str = "log10_p_ref = { uniform = [4.0, 5.6] }\nkappa = 0.0\nn = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }\nfriction_angle_deg = { normal = [30.0, 5.7], bounds = [11.5, 37.3] }\nwheel_radius_m = { uniform = [0.125, 0.155] }\n";

/// Runs of the experiment with these effects, at the parameters of the reference campaign and of the effects.
fn campaign(folder: &Path, effects: &str, strengths: &str) -> String {
    let (model, parameters) = (folder.join("model.toml"), folder.join("parameters.toml"));
    let original = text(&data("nothing-hidden/model.toml"));
    std::fs::write(&model, format!("{original}effects = {effects}\n")).expect("a model");
    let original = text(&data("nothing-hidden/parameters.toml"));
    std::fs::write(&parameters, format!("{original}{strengths}\n")).expect("parameters");
    let out = folder.join("campaign.csv");
    let mut command = worker(["simulate", "--noise-seed", "7"]);
    command.arg(data("nothing-hidden/experiment.toml"));
    command
        .arg("--model")
        .arg(&model)
        .arg("--parameters")
        .arg(&parameters);
    command.arg("--out").arg(&out);
    run(command).success();
    text(&out)
}

/// Runs a job; its summary and its posterior.
fn calibrated(job: &Job, folder: &Path) -> (Value, String) {
    let path = job.write(folder).display().to_string();
    let out = folder.join("out");
    run(coordinator(["run", &path, "--out", &out.display().to_string()])).success();
    let summary = serde_json::from_str(&text(&out.join("summary.json"))).expect("JSON");
    (summary, text(&out.join("posterior.csv")))
}

/// Returns the job of the next campaign: the posterior of the last is its prior.
fn next(runs: String, posterior: &str) -> Job {
    let job = Job { runs, ..Job::small() };
    job.in_job(SAMPLER, FIT)
        .in_job(PRIORS, "posterior = \"reference.csv\"\nkappa = 0.0\n")
        .beside("reference.csv", posterior)
}

#[test]
fn what_changed_since_a_reference_campaign_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let (reference, posterior) = calibrated(&Job::small().in_job(SAMPLER, FIT), &at("reference"));
    let line = &reference["calibrations"][0];
    assert_eq!(line["algorithm"], "lm");
    assert_eq!(line["normal_approximation"], true);
    assert!(line["log_evidence"].is_f64(), "{line}");
    assert!(line["log_evidence_se"].is_null(), "{line}");
    assert!(
        line["coverage90"]["holdout"]
            .as_f64()
            .is_some_and(|share| share > 0.75),
        "{line}"
    );
    assert_eq!(posterior.lines().count(), 1001);

    std::fs::create_dir(at("simulated")).expect("a folder");
    let runs = campaign(
        &at("simulated"),
        "[\"janosi_hanamoto\"]",
        "\"janosi_hanamoto.shear_modulus_m\" = 0.01",
    );
    let job = next(runs, &posterior);
    let job = Job {
        job: job.job + "[discovery]\napply = \"auto\"\n",
        ..job
    };
    let (changed, posterior) = calibrated(&job, &at("changed"));
    let discovery = &changed["discovery"];
    assert_eq!(
        discovery["chosen"][0], "janosi_hanamoto",
        "{}",
        discovery["verdict"]
    );
    let [base, with] =
        [0, 1].map(|i| changed["calibrations"][i]["error"]["holdout"]["all"]["rmse_sigma"].as_f64());
    assert!(base > Some(2.0) && with < Some(1.3), "{base:?}, {with:?}");

    // If the next job has the effect, its strength is part of the prior.
    let third = next(Job::small().runs, &posterior).in_job(
        "kind = \"quasi_static\"",
        "kind = \"quasi_static\"\neffects = [\"janosi_hanamoto\"]",
    );
    let path = third.write(&at("third")).display().to_string();
    let check = run(coordinator(["check", &path])).success();
    assert_contains!(
        check,
        "wheel_radius_m, janosi_hanamoto.shear_modulus_m: jointly normal as 1000 draws of reference.csv"
    );
}
