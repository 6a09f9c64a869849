//! Histories in the likelihood: what the sinkage before the steady state tells, and what is held out because it never is steady.

use std::fmt::Write;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{float, items};
use farm_tests::programs::{coordinator, run};
use serde_json::Value;

/// The wheel of the small job.
const RADIUS_M: f64 = 0.125;
/// Travel at which the slip of each recording begins `[m]`.
const SLIP_BEGINS_M: f64 = 0.1;
/// Travel between two samples `[m]`, one second apart.
const SPACING_M: f64 = 0.004;

/// Returns the sinkage along a recording that settles to `steady_m` by `dz/dx = z_e/(m L) (1 − (z/z_e)^m)`, in steps of a tenth of a
/// sample, with an error of 0.1 mm that is correlated along the travel.
fn recording(steady_m: f64, exponent: f64, phase: f64) -> Vec<f64> {
    let contact_m = (2.0 * RADIUS_M * steady_m).sqrt();
    let mut z = 0.4 * steady_m;
    let sample = |k: u32| {
        let travel_m = SPACING_M * f64::from(k);
        for _ in 0..10 {
            if travel_m > SLIP_BEGINS_M {
                let carried = (z / steady_m).powf(exponent);
                z += 0.1 * SPACING_M * steady_m / (exponent * contact_m) * (1.0 - carried);
            }
        }
        z + 1e-4 * (travel_m / 0.03 + phase).sin()
    };
    (1..=150).map(sample).collect()
}

/// Returns the small job with recordings of its sinkages, which settle by an exponent m; the first run sinks on and on.
fn job(exponent: f64, likelihood: &str) -> Job {
    let small = Job::small()
        .in_experiment(
            "[soil.s]",
            "[soil.s]\n[protocol]\nmeasured_transient_s = 100.0\nlowpass_hz = 0\nslip_begins_m = 0.1",
        )
        .in_job("[sampler]", &format!("[likelihood]\n{likelihood}\n[sampler]"));
    let mut histories = "run,t_s,travel_m,sinkage_m\n".to_owned();
    let mut runs = String::new();
    for line in small.runs.lines().filter(|line| !line.starts_with('#')) {
        let cells: Vec<&str> = line.split(',').collect();
        let [name, condition @ .., sinkage, lateral, usage] = cells.as_slice() else {
            panic!("{line}");
        };
        let condition = condition.join(",");
        let Ok(steady_m) = sinkage.parse::<f64>() else {
            let _ = writeln!(runs, "{name},{condition},{sinkage},{lateral},{usage},history");
            continue;
        };
        let _ = writeln!(runs, "{name},{condition},,{lateral},{usage},histories.csv");
        for (k, z) in recording(steady_m, exponent, runs.len() as f64)
            .iter()
            .enumerate()
        {
            let travel_m = SPACING_M * (k + 1) as f64;
            let drift = if *name == "r00" { 0.02 * travel_m } else { 0.0 };
            let _ = writeln!(histories, "{name},{},{travel_m},{}", k + 1, z + drift);
        }
    }
    Job { runs, ..small }.beside("histories.csv", histories)
}

/// Returns the summary of the calibration that `run` leaves, and what it says.
fn calibrated(job: &Job) -> (Value, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out");
    let text = run(coordinator([
        "run",
        "--verbose",
        &path,
        "--out",
        &out.display().to_string(),
    ]))
    .success();
    let summary = std::fs::read_to_string(out.join("summary.json")).expect("summary.json");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let calibration = items(&summary["calibrations"]).next().expect("a calibration");
    (calibration.clone(), text)
}

fn exponent(calibration: &Value) -> [f64; 2] {
    let n = &calibration["parameters"]["n"];
    ["mean", "sd"].map(|key| float(&n[key]))
}

#[test]
fn histories_tell_the_exponent_of_the_soil_and_are_predicted() {
    let (averages, _) = calibrated(&job(1.9, ""));
    let (histories, text) = calibrated(&job(1.9, "histories = true"));
    let ([_, sd], [mean, sd_with]) = (exponent(&averages), exponent(&histories));
    assert!(
        sd_with < 0.8 * sd,
        "sd {sd} without histories, {sd_with} with them"
    );
    let (steeper, _) = calibrated(&job(2.4, "histories = true"));
    let [steeper, _] = exponent(&steeper);
    assert!(steeper > mean + 2.0 * sd_with, "{mean} +- {sd_with}, {steeper}");
    assert!(averages.get("transient_errors").is_none());
    let errors: Vec<&Value> = items(&histories["transient_errors"]).collect();
    let rmse_of = |usage: &str| -> Vec<f64> {
        let groups = errors.iter().filter(|errors| errors["use"] == usage);
        groups
            .filter(|errors| errors["holdout_group"] != "not_steady")
            .map(|errors| float(&errors["rmse_m"]))
            .collect()
    };
    // The errors of the steady sinkage are 0.4 mm, those along the travel 0.1 mm.
    assert!(
        rmse_of("fit").len() == 1 && rmse_of("fit")[0] < 6e-4,
        "{errors:?}"
    );
    assert!(
        !rmse_of("holdout").is_empty() && rmse_of("holdout").iter().all(|rmse| *rmse < 1e-3),
        "{errors:?}"
    );
    let unsteady = errors
        .iter()
        .find(|errors| errors["holdout_group"] == "not_steady");
    assert_eq!(unsteady.map(|errors| errors["runs"].clone()), Some(1.into()));
    assert_contains!(
        text,
        "noise.transient_sinkage_m",
        "noise.transient_model_m",
        "noise.transient_length_m",
        "sinkage before it is steady"
    );
}

#[test]
fn a_planned_run_is_predicted_without_the_histories_of_others() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job(1.9, "histories = true")
        .write(&folder.path().join("job"))
        .display()
        .to_string();
    let out = folder.path().join("out").display().to_string();
    run(coordinator(["run", &path, "--out", &out])).success();
    let predicted = run(coordinator([
        "predict", "--at", "slip=0.3", "--out", &out, "--format", "json",
    ]));
    assert_contains!(predicted.success(), "sinkage");
}

#[test]
fn a_run_that_sinks_on_is_named_and_held_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job(1.9, "").write(folder.path()).display().to_string();
    let text = run(coordinator(["check", &path])).success();
    assert_contains!(text, "r00", "23 fit runs");
}

#[test]
fn histories_that_nothing_recorded_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let refusal = |job: Job, name: &str| {
        let written = job.write(&path(name)).display().to_string();
        run(coordinator(["check", &written])).refusal()
    };
    let unrecorded = Job::small().in_job("[sampler]", "[likelihood]\nhistories = true\n[sampler]");
    assert_contains!(
        refusal(unrecorded, "unrecorded"),
        "[likelihood] histories = true, but no fit run has a recorded sinkage above 0 m"
    );
    let steady = job(1.9, "histories = true").in_job("kind = \"quasi_static\"", "kind = \"rft\"");
    assert_contains!(refusal(steady, "steady"), "rft");
    let unused = job(1.9, "").in_job(
        "[priors]",
        "[priors]\n\"noise.transient_length_m\" = { uniform = [0.01, 1.0] }",
    );
    assert_contains!(
        refusal(unused, "unused"),
        "noise.transient_length_m has a prior, but no history that is fitted needs it"
    );
}
