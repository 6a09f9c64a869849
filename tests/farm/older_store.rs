//! Stores that the versions before migrations 9, 20 and 23 wrote: they are read, go on where they can, and give what those versions gave.

use std::path::PathBuf;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::workspace::{data, text};
use serde_json::Value;
use sqlx::Connection as _;
use tempfile::TempDir;

/// Returns the job of one of these versions in a folder, and in `out` beside it one of the stores that were kept of it.
fn folder(version: &str, store: &str) -> (TempDir, PathBuf, PathBuf) {
    let temporary = tempfile::tempdir().expect("a folder");
    let (job, out) = (temporary.path().join("job"), temporary.path().join("out"));
    for made in [&job, &out] {
        std::fs::create_dir(made).expect("a folder");
    }
    let kept = |name: &str| data(version).join(name);
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

/// Numbers of a posterior and its evidence in a summary.
const POSTERIOR: [&str; 6] = [
    "/calibrations/0/log_evidence",
    "/calibrations/0/parameters",
    "/calibrations/0/error/fit/all/rmse_sigma",
    "/calibrations/0/error/fit/drawbar_pull/rmse",
    "/calibrations/0/error/fit/sinkage/rmse",
    "/calibrations/0/evaluations",
];

/// Numbers of a point estimate in a summary.
const POINT_ESTIMATE: [&str; 2] = [
    "/point_estimates/0/parameters",
    "/point_estimates/0/log_posterior",
];

/// The numbers of a summary are those that an older version stated.
#[track_caller]
fn same_numbers(version: &str, summary: &str, numbers: &[&str]) {
    let given: Value = serde_json::from_str(summary).expect("JSON");
    let kept: Value = serde_json::from_str(&text(&data(version).join("summary.json"))).expect("JSON");
    for number in numbers {
        let at = |summary: &Value| summary.pointer(number).cloned();
        assert!(at(&kept).is_some(), "{number}");
        assert_eq!(at(&given), at(&kept), "{number}");
    }
}

#[test]
fn a_finished_one_is_shown_before_and_after_its_tables_are_brought_up_to_date() {
    let (_temporary, job, out) = folder("store-8", "finished.store");
    let posterior = text(&data("store-8/posterior.csv"));
    // Commands that only read do not migrate the store.
    same(&command(&["export", "1", "--format", "csv"], &out), &posterior);
    let report = command(&["report", "1"], &out);
    // The figure has this mark only if the predictions of the likeliest draw are found among the stored evaluations.
    assert!(report.contains("maximum likelihood"));
    let rerun = command(&["run", &job.display().to_string()], &out);
    let summary = text(&out.join("summary.json"));
    same_numbers("store-8", &summary, &POSTERIOR);
    same_numbers("store-8", &summary, &POINT_ESTIMATE);
    same(&text(&out.join("posterior.csv")), &posterior);
    same(&text(&out.join("report.html")), &report);
    same(&command(&["report", "1"], &out), &report);
    same(&command(&["run", &job.display().to_string()], &out), &rerun);
}

#[test]
fn a_stopped_one_goes_on_and_ends_with_the_same_posterior_and_fit() {
    let (_temporary, job, out) = folder("store-8", "stopped.store");
    command(&["run", &job.display().to_string()], &out);
    let summary = text(&out.join("summary.json"));
    same_numbers("store-8", &summary, &POSTERIOR);
    same_numbers("store-8", &summary, &POINT_ESTIMATE);
    same(
        &text(&out.join("posterior.csv")),
        &text(&data("store-8/posterior.csv")),
    );
}

/// Rounds all numbers within a value to twelve digits.
fn round(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(round),
        Value::Object(table) => table.values_mut().for_each(round),
        Value::Number(number) => {
            let rounded = format!("{:.11e}", number.as_f64().expect("a number"));
            *value = rounded.parse::<f64>().expect("a number").into();
        }
        _ => (),
    }
}

/// The statements of the version before migration 20 about its study.
#[track_caller]
fn same_study(summary: &str) {
    let mut given: Value = serde_json::from_str(summary).expect("JSON");
    let mut kept: Value = serde_json::from_str(&text(&data("store-19/summary.json"))).expect("JSON");
    // That version did not say which calibration an estimate is of, nor the groups of its held-out runs.
    for estimate in given["point_estimates"].as_array_mut().expect("a list") {
        let mut remove = |path: &str, key: &str| {
            let table = estimate.pointer_mut(path).and_then(Value::as_object_mut);
            table.and_then(|table| table.remove(key)).expect(key);
        };
        remove("", "calibration");
        for path in ["", "/baseline", "/corrected"] {
            remove(path, "holdout_groups");
        }
    }
    // Corrections are computed with the summary. Their sums have had another order since.
    for summary in [&mut given, &mut kept] {
        for estimate in summary["point_estimates"].as_array_mut().expect("a list") {
            round(&mut estimate["corrected"]);
        }
    }
    for fact in [
        "/discovery/verdict",
        "/discovery/chosen",
        "/discovery/evaluations",
        "/point_estimates",
    ] {
        assert!(kept.pointer(fact).is_some(), "{fact}");
        assert_eq!(given.pointer(fact), kept.pointer(fact), "{fact}");
    }
    let lists = [
        (
            "/calibrations",
            [
                "effects",
                "algorithm",
                "log_evidence",
                "evaluations",
                "parameters",
                "error",
            ]
            .as_slice(),
        ),
        ("/discovery/rounds", ["given", "verdict"].as_slice()),
    ];
    for (list, keys) in lists {
        let list_of = |summary: &Value| {
            summary
                .pointer(list)
                .and_then(Value::as_array)
                .cloned()
                .expect("a list")
        };
        let (given, kept) = (list_of(&given), list_of(&kept));
        assert_eq!(given.len(), kept.len(), "{list}");
        for (given, kept) in given.iter().zip(&kept) {
            for key in keys {
                assert!(!kept[key].is_null(), "{list} {key}");
                assert_eq!(given[key], kept[key], "{list} {key}");
            }
        }
    }
}

/// Name, role, parent and change of each stored calibration.
async fn stored_members(store: &std::path::Path) -> Vec<(String, String, Option<i64>, Option<String>)> {
    let url = format!("sqlite://{}?mode=ro", store.display());
    let mut connection = sqlx::SqliteConnection::connect(&url).await.expect("a store");
    sqlx::query_as("SELECT name, role, parent, change FROM calibrations ORDER BY id")
        .fetch_all(&mut connection)
        .await
        .expect("rows")
}

#[tokio::test]
async fn a_study_of_before_its_members_were_stored_is_the_same_study() {
    let (_temporary, job, out) = folder("store-19", "finished.store");
    // Commands that only read do not migrate, and find the searches by the rules of that version.
    assert!(command(&["report", "1"], &out).contains("janosi_hanamoto"));
    command(&["run", &job.display().to_string()], &out);
    same_study(&text(&out.join("summary.json")));
    let add = r#"{"add":{"effect":"janosi_hanamoto"}}"#;
    let lm = r#"{"algorithm":"lm"}"#;
    let expected = [
        ("mk19", "sample", None, None),
        ("mk19 (lm)", "fit", Some(1), Some(lm)),
        ("mk19 (discovery)", "search", Some(1), None),
        ("mk19+janosi_hanamoto", "sample", Some(1), Some(add)),
        ("mk19+janosi_hanamoto (discovery)", "search", Some(4), None),
    ];
    let given = stored_members(&out.join("grouser.db")).await;
    let given: Vec<_> = given
        .iter()
        .map(|(name, role, parent, change)| (name.as_str(), role.as_str(), *parent, change.as_deref()))
        .collect();
    assert_eq!(given, expected, "nothing is searched again");
}

#[tokio::test]
async fn a_store_whose_new_columns_are_still_empty_can_be_read() {
    let (_temporary, _, out) = folder("store-19", "finished.store");
    let mut connection = sqlx::SqliteConnection::connect(&store_in(&out))
        .await
        .expect("a store");
    // This is the state after a kill between the creation of the columns and the computation of their values.
    let columns = sqlx::raw_sql(include_str!("../../migrations/0020_members.sql"));
    columns.execute(&mut connection).await.expect("new columns");
    connection.close().await.expect("closed");
    assert!(command(&["report", "1"], &out).contains("janosi_hanamoto"));
}

/// The sentence about a job that states the moves of a metamodel.
const REMOVED: &str = "job.toml line 18: metamodel_moves was removed, because stages = \"emulated\" finds the same posterior with fewer evaluations: submit the job with that in place of this line";

/// Returns the URL of the store in a folder.
fn store_in(out: &std::path::Path) -> String {
    format!("sqlite://{}", out.join("grouser.db").display())
}

#[test]
fn a_finished_one_with_a_metamodel_is_shown_before_and_after_its_columns_are_dropped() {
    let (_temporary, _, out) = folder("store-22", "finished.store");
    let posterior = text(&data("store-22/posterior.csv"));
    same(&command(&["export", "1", "--format", "csv"], &out), &posterior);
    let report = command(&["report", "1"], &out);
    let service = Service::start_on(&store_in(&out), &[]);
    same(&service.posterior_csv(1), &posterior);
    same_numbers("store-22", &service.result(1, "summary").to_string(), &POSTERIOR);
    assert_eq!(service.status(1)["state"], "finished");
    assert_eq!(service.client.json("/v1/studies")[0]["id"], 1);
    drop(service);
    same(&command(&["report", "1"], &out), &report);
}

/// A job that leaves the stages to the program was sampled by draws of the model when that version ran it, whatever is sampled on an
/// emulator today.
#[tokio::test]
async fn a_finished_one_whose_job_would_have_an_emulator_today_has_the_prior_draws_that_it_had() {
    let (_temporary, _, out) = folder("store-22", "finished.store");
    let url = store_in(&out);
    let mut connection = sqlx::SqliteConnection::connect(&url).await.expect("a store");
    let job = "UPDATE calibrations SET toml = replace(replace(toml, 'moves = [2, 4]', ''), 'metamodel_moves = 8', '')";
    sqlx::query(job)
        .execute(&mut connection)
        .await
        .expect("another job");
    connection.close().await.expect("closed");
    let service = Service::start_on(&url, &[]);
    let rejections = service.result(1, "diagnostics")["rejections"].clone();
    assert_eq!(rejections["prior_draws"], 20, "{rejections}");
}

#[test]
fn an_unfinished_one_with_a_metamodel_is_refused_and_others_go_on() {
    let (_temporary, job, out) = folder("store-22", "stopped.store");
    let mut service = Service::start_on(&store_in(&out), &["--local-workers", "1"]);
    let other = service.submit(&Job::small());
    for _ in 0..2 {
        let refused = service.status(1)["message"].clone();
        assert_contains!(refused.as_str().expect("a message"), REMOVED);
        service.crash();
    }
    service.wait_for(other, "finished");
    assert_eq!(
        service.client.json("/v1/studies").as_array().map(Vec::len),
        Some(2)
    );
    let job = job.display().to_string();
    let again = run(coordinator([
        "run",
        job.as_str(),
        "--out",
        out.display().to_string().as_str(),
    ]));
    assert_contains!(again.refusal(), REMOVED);
}
