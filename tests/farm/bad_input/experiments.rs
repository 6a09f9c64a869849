//! Wrong experiments, and files that are none, through `check` and `run`.

use std::path::Path;

use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};

use super::{refusal, refusal_in, refused};

const FIRST_RUN: &str = "r00,w,s,0.05,60.0,0.0095,0,1,8.4839442,2.4143027,0.0055360117,,fit";

#[test]
fn the_job_of_the_gallery_is_good() {
    let folder = tempfile::tempdir().unwrap();
    let path = Job::small().write(folder.path()).display().to_string();
    let text = run(coordinator(["check", &path])).success();
    assert!(
        text.contains("24 fit runs with 72 measurements, 16 holdout runs"),
        "{text}"
    );
    for figure in [
        "expected evaluations",
        "expected simulations",
        "expected core hours",
    ] {
        assert!(text.contains(figure), "{text}");
    }
}

#[test]
fn unit_mistakes_name_value_unit_and_bound() {
    let row = |old: &str, new: &str| Job::small().in_runs(FIRST_RUN, &FIRST_RUN.replace(old, new));
    refused(
        row("60.0", "-60.0"),
        "runs.csv line 4: wheel_load_n -60 N must be > 0 N",
    );
    refused(
        row(",0.05,", ",1,"),
        "runs.csv line 4: slip 1 must lie in [-1, 1)",
    );
    refused(
        row(",0.05,", ",-1.2,"),
        "runs.csv line 4: slip -1.2 must be at least -1: was it typed in per cent (-0.012)?",
    );
    refused(
        row("0.0055360117", "5.5360117"),
        "runs.csv line 4: sinkage_m 5.5360117 m is more than the wheel's diameter 0.25 m: metres are expected, were these millimetres or centimetres?",
    );
    refused(
        row("0.0095", "0"),
        "runs.csv line 4: sled_speed_m_s 0 m/s must be > 0 m/s",
    );
    refused(
        row("0.0095,0,", "0.0095,120,"),
        "runs.csv line 4: slip_angle_deg 120 deg must lie in [-90, 90] deg",
    );
    refused(
        Job::small().in_experiment("radius_m = 0.125\nwidth", "radius_m = -0.125\nwidth"),
        "experiment.toml: [wheel.w] radius_m -0.125 m must be > 0 m",
    );
    refused(
        Job::small().in_experiment("torque_n_m = 0.15", "torque_n_m = 0.0"),
        "experiment.toml: [noise] torque_n_m 0 N m must be > 0 N m",
    );
}

#[test]
fn malformed_rows_name_the_line() {
    let row = |old: &str, new: &str| Job::small().in_runs(FIRST_RUN, &FIRST_RUN.replace(old, new));
    refused(
        row("8.4839442", "NaN"),
        "runs.csv line 4: drawbar_pull_n NaN is not a finite number",
    );
    refused(
        row("8.4839442", "inf"),
        "runs.csv line 4: drawbar_pull_n inf is not a finite number",
    );
    refused(
        row("8.4839442", "eight"),
        "runs.csv line 4: drawbar_pull_n \"eight\" is not a number",
    );
    refused(row("60.0", ""), "runs.csv line 4: wheel_load_n is blank");
    refused(
        row(",fit", ""),
        "runs.csv line 4: 12 fields where the header has 13",
    );
    refused(
        row(",fit", ",both"),
        "runs.csv line 4: use \"both\" must be fit or holdout",
    );
    refused(
        row(",w,", ",v,"),
        "runs.csv line 4: unknown wheel \"v\"; known are w",
    );
    refused(
        row(",1,8", ",0,8"),
        "runs.csv line 4: pass \"0\" must be a whole number >= 1",
    );
    refused(
        Job::small().in_runs("\nr01,", "\nr00,"),
        "runs.csv line 5: run \"r00\" appears twice (first on line 4)",
    );
    refused(
        Job {
            runs: Job::small().runs.replace("slip,", "").replace(",s,0.05,", ",s,"),
            ..Job::small()
        },
        "runs.csv line 3: column \"slip\" is missing",
    );
    refused(
        Job::small().in_runs("torque_n_m,", "drawbar_pull_n,"),
        "runs.csv line 3: column \"drawbar_pull_n\" appears twice",
    );
}

#[test]
fn an_experiment_without_anything_to_fit_is_refused() {
    let header = Job::small()
        .runs
        .lines()
        .nth(2)
        .map(|line| format!("{line}\n"))
        .unwrap_or_default();
    refused(
        Job {
            runs: header,
            ..Job::small()
        },
        "runs.csv: the file has no test run",
    );
    refused(
        Job {
            runs: String::new(),
            ..Job::small()
        },
        "runs.csv line 1: columns run, wheel, soil, slip, wheel_load_n, sled_speed_m_s are missing",
    );
    refused(
        Job {
            runs: Job::small().runs.replace(",fit", ",holdout"),
            ..Job::small()
        },
        "experiment.toml: no fit run has a measured channel: there is nothing to fit",
    );
    refused(
        Job {
            experiment: String::new(),
            ..Job::small()
        },
        "experiment.toml: no wheel: add a table [wheel.NAME]",
    );
    refused(
        Job::small().in_experiment("sinkage_m = 0.0004", ""),
        "experiment.toml: [noise] sinkage_m is missing: sinkage_m of run \"r00\" is measured, so its sd in m, \"replicates\" or \"unknown\" must be given there",
    );
}

#[test]
fn files_that_are_not_there_or_not_text_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = Job::small().write(folder.path());
    let message = |path: &Path| refusal_in(path, folder.path());
    assert!(
        message(&folder.path().join("jop.toml"))
            .starts_with("jop.toml: there is no such file; the nearest in its folder is")
    );
    let directory = message(folder.path());
    assert!(directory.contains("directory"), "{directory}");

    let garbage: Vec<u8> = (0..=255).cycle().take(4096).collect();
    for name in ["job.toml", "experiment.toml", "runs.csv"] {
        let text = std::fs::read(folder.path().join(name)).unwrap();
        std::fs::write(folder.path().join(name), &garbage).unwrap();
        let said = message(&path);
        assert!(said.starts_with(name) && said.contains("UTF-8"), "{said}");
        std::fs::remove_file(folder.path().join(name)).unwrap();
        let said = message(&path);
        assert!(
            said.starts_with(&format!("{name}: there is no such file")),
            "{said}"
        );
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let job = Job::small().in_job("experiment = \"experiment.toml\"", "");
    refused(job, "job.toml: experiment = \"experiment.toml\" is missing");
    let broken = refusal(&Job::small().in_job("[priors]", "[priors"));
    assert!(broken.starts_with("job.toml line 7: "), "{broken}");
}

#[test]
fn numbers_of_rig_soil_and_protocol_are_checked() {
    let with = |table: &str| Job::small().in_experiment("[noise]", &format!("{table}\n[noise]"));
    refused(
        with("[protocol]\nlowpass_hz = nan"),
        "experiment.toml: [protocol] lowpass_hz NaN Hz must be >= 0 Hz",
    );
    refused(
        with("[protocol]\nmeasured_transient_s = -5.0"),
        "experiment.toml: [protocol] measured_transient_s -5 s must be >= 0 s",
    );
    refused(
        with("[rig]\nbin_length_m = 0.0"),
        "experiment.toml: [rig] bin_length_m 0 m must be > 0 m",
    );
}
