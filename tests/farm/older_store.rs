//! A store that the version before migration 9 wrote: it is read, goes on, and gives what that version gave.

use std::path::PathBuf;

use farm_tests::programs::{coordinator, run};
use farm_tests::text::same;
use farm_tests::workspace::{data, text};
use serde_json::Value;
use tempfile::TempDir;

/// The job in a folder, and in `out` beside it one of the stores that were kept of it.
fn folder(store: &str) -> (TempDir, PathBuf, PathBuf) {
    let temporary = tempfile::tempdir().expect("a folder");
    let (job, out) = (temporary.path().join("job"), temporary.path().join("out"));
    for made in [&job, &out] {
        std::fs::create_dir(made).expect("a folder");
    }
    let kept = |name: &str| data("store-8").join(name);
    for file in ["job.toml", "experiment.toml", "runs.csv"] {
        std::fs::copy(kept(file), job.join(file)).expect("a file is copied");
    }
    std::fs::copy(kept(store), out.join("grouser.db")).expect("the store is copied");
    (temporary, job.join("job.toml"), out)
}

fn command(words: &[&str], out: &std::path::Path) -> String {
    let out = out.display().to_string();
    run(coordinator(words.iter().copied().chain(["--out", out.as_str()]))).success()
}

/// What the older version stated of posterior, evidence and point estimate.
#[track_caller]
fn same_numbers(summary: &str) {
    let given: Value = serde_json::from_str(summary).expect("JSON");
    let kept: Value = serde_json::from_str(&text(&data("store-8/summary.json"))).expect("JSON");
    for number in [
        "/calibrations/0/log_evidence",
        "/calibrations/0/parameters",
        "/calibrations/0/error/fit/all/rmse_sigma",
        "/calibrations/0/error/fit/drawbar_pull/rmse",
        "/calibrations/0/error/fit/sinkage/rmse",
        "/calibrations/0/evaluations",
        "/point_estimates/0/parameters",
        "/point_estimates/0/log_posterior",
    ] {
        let at = |summary: &Value| summary.pointer(number).cloned();
        assert!(at(&kept).is_some(), "{number}");
        assert_eq!(at(&given), at(&kept), "{number}");
    }
}

#[test]
fn a_finished_one_is_shown_before_and_after_its_tables_are_brought_up_to_date() {
    let (_temporary, job, out) = folder("finished.store");
    let posterior = text(&data("store-8/posterior.csv"));
    // Commands that only read do not migrate.
    same(&command(&["export", "1", "--format", "csv"], &out), &posterior);
    let report = command(&["report", "1"], &out);
    // Without the likeliest draw's values, which are found among those of every evaluation, this mark would be missing.
    assert!(report.contains("maximum likelihood"));
    let rerun = command(&["run", &job.display().to_string()], &out);
    same_numbers(&text(&out.join("summary.json")));
    same(&text(&out.join("posterior.csv")), &posterior);
    same(&text(&out.join("report.html")), &report);
    same(&command(&["report", "1"], &out), &report);
    same(&command(&["run", &job.display().to_string()], &out), &rerun);
}

#[test]
fn a_stopped_one_goes_on_and_ends_with_the_same_posterior_and_fit() {
    let (_temporary, job, out) = folder("stopped.store");
    command(&["run", &job.display().to_string()], &out);
    same_numbers(&text(&out.join("summary.json")));
    same(
        &text(&out.join("posterior.csv")),
        &text(&data("store-8/posterior.csv")),
    );
}
