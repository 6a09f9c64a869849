//! The work of a user: serve, submit, workers, a crash, results, and the controls of a calibration.

use std::collections::BTreeMap;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{item_count, items, whole, word};
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::{until, until_true};
use serde_json::{Value, json};

/// Returns a verb of the command line against a service.
#[track_caller]
fn verb(service: &Service, words: &[&str]) -> String {
    run(coordinator(words.iter().chain(&["--url", &service.url()]))).success()
}

#[test]
fn two_jobs_outlive_a_crash_of_the_coordinator_and_give_results() {
    let mut service = Service::start(&[]);
    assert_eq!(service.client.json("/health")["status"], "ok");
    assert_eq!(service.client.json("/v1/calibrations"), json!([]));

    // One job by the command line, another by plain HTTP.
    let job = Job::small().sampler(150, [3, 6], 1);
    let path = job.write(&service.folder().join("sand")).display().to_string();
    assert_eq!(verb(&service, &["submit", &path]), "calibration 1 of study 1\n");
    let other = Job::small().sampler(100, [3, 6], 2);
    let experiment = service.client.post("/v1/experiments", &other.experiment_json());
    assert_eq!((experiment.status, experiment.json()), (201, json!({"id": 2})));
    let new = json!({"experiment": 2, "toml": other.job, "name": "by hand"});
    let created = service.client.post("/v1/calibrations", &new);
    assert_eq!(created.status, 201);
    assert_eq!(created.json(), json!({"id": 2, "study": 2}));
    assert_eq!(created.header("location"), Some("/v1/calibrations/2"));
    let list = verb(&service, &["list"]);
    assert!(list.contains("sand"), "{list}");
    assert!(list.contains("by hand"), "{list}");
    assert!(list.matches("queued").count() == 2, "{list}");

    let mut workers = [service.worker("first", 1), service.worker("second", 1)];
    let moved = |service: &Service, from: u64| {
        until("progress", || {
            service.evaluations(1).filter(|&evaluations| evaluations > from)
        })
    };
    let before = moved(&service, 300);
    let status = verb(&service, &["status", "1"]);
    assert_contains!(status, "running");

    service.kill();
    assert!(workers.iter_mut().all(|w| w.is_running()));
    service.restart();
    let after = service.evaluations(1);
    assert!(
        after >= Some(before),
        "{after:?} of {before} evaluations were kept"
    );
    moved(&service, after.unwrap_or(before));
    for worker in &mut workers {
        assert!(worker.is_running(), "{}", worker.log());
    }
    until("both workers back", || {
        let workers = service.client.json("/v1/workers");
        let records = workers.as_object()?;
        (records.len() == 2 && records.values().all(|w| w["completed"].as_u64() > Some(0))).then_some(())
    });
    service.wait_for(1, "finished");
    service.wait_for(2, "finished");
    let list = verb(&service, &["list"]);
    assert_eq!(list.matches("finished").count(), 2, "{list}");

    // Results, by verbs and over HTTP.
    let compared = verb(&service, &["compare", "1"]);
    assert_contains!(
        compared,
        "r00",
        "r39",
        "holdout measurements",
        "pull N",
        "90 % interval"
    );
    let diagnosed = verb(&service, &["diagnose", "1"]);
    assert_contains!(
        diagnosed,
        "effective sample size",
        "information",
        "contraction",
        "largest residuals",
        "chi-square"
    );
    let report = verb(&service, &["report", "1"]);
    assert!(report.to_lowercase().starts_with("<!doctype html>"), "{report}");
    assert!(report.contains("sand"), "{report}");
    let file = service.folder().join("report.html");
    assert_eq!(
        verb(
            &service,
            &["report", "1", "--output", &file.display().to_string()]
        ),
        ""
    );
    assert_eq!(std::fs::read_to_string(&file).unwrap(), report);
    let csv = verb(&service, &["export", "1", "--format", "csv"]);
    let header = "log_likelihood,log_prior,log10_p_ref,n,friction_angle_deg,wheel_radius_m";
    assert_eq!((csv.lines().next(), csv.lines().count()), (Some(header), 151));
    let exported: Value =
        serde_json::from_str(&verb(&service, &["export", "1", "--format", "json"])).unwrap();
    assert_eq!(exported["summary"]["status"], "finished");
    assert_eq!(item_count(&exported["posterior"]["rows"]), 150);
    assert_eq!(item_count(&exported["comparison"]["rows"]), 40 * 3);
    for part in [
        "stages",
        "samples",
        "posterior",
        "comparison",
        "diagnostics",
        "flags",
        "summary",
    ] {
        let answer = service.client.json(&format!("/v1/calibrations/2/{part}"));
        assert!(answer.is_object() || answer.is_array(), "{part}: {answer}");
    }
    let part = service.client.json("/v1/calibrations/2/samples?most=10");
    let all_samples = service.result(2, "samples");
    assert_eq!(part["of"].as_u64(), Some(100));
    assert_eq!(all_samples["of"].as_u64(), Some(100));
    assert_eq!(
        all_samples["parameters"],
        json!(["log10_p_ref", "n", "friction_angle_deg", "wheel_radius_m"])
    );
    assert_eq!(all_samples["units"], json!(["log10 Pa", "1", "deg", "m"]));
    let spaced = (0..10).map(|k| all_samples["samples"][10 * k + 9].clone());
    assert_eq!(part["samples"], spaced.collect::<Value>());
    let studies = service.client.json("/v1/studies");
    for (key, value) in [
        ("id", json!(2)),
        ("experiment", json!(2)),
        ("calibrations", json!([2])),
        ("archived", json!(false)),
        ("state", json!("finished")),
        ("model_kind", json!("quasi_static")),
    ] {
        assert_eq!(studies[1][key], value, "{key}");
    }
    until("the errors of the study in the list", || {
        let item = &service.client.json("/v1/studies")[0];
        item["error"]["fit"]["drawbar_pull"]["rmse"].as_f64()
    });
    let ledger = service.client.json("/v1/studies/1")["ledger"].clone();
    assert_eq!(
        ledger[0]["evaluations"],
        exported["summary"]["calibrations"][0]["evaluations"]
    );

    // Without the coordinator, the commands give the same results from the store.
    assert!(service.terminate());
    let folder = service.folder().display().to_string();
    let alone = run(coordinator(["export", "1", "--out", &folder])).success();
    same(&alone, &csv);
    assert_eq!(
        run(coordinator(["diagnose", "1", "--out", &folder])).success(),
        diagnosed
    );
}

#[test]
fn pausing_resuming_and_cancelling_do_what_they_say() {
    let mut service = Service::start(&["--local-workers", "1"]);
    let job = Job::small().sampler(300, [8, 16], 1);
    let id = service.submit(&job);
    until("progress", || service.evaluations(id).filter(|&n| n > 100));
    assert_eq!(verb(&service, &["pause", "1"]), "calibration 1 is paused\n");
    // Leased evaluations are completed; after that the calibration does not progress, even after a restart.
    until_true("no lease", || service.metric("grouser_leases_out") == 0);
    let paused = service.status(id);
    assert_eq!(paused["state"].as_str(), Some("paused"));
    assert_eq!(paused["message"].as_str(), Some("paused by a user"));
    let given = service.metric("grouser_leases_given_total");
    assert_eq!(service.act(1, "pause").status, 409);
    let other = service.calibrate(&Job::small());
    assert_eq!(
        service.evaluations(id),
        paused["progress"]["evaluations"].as_u64()
    );
    assert!(service.metric("grouser_leases_given_total") > given);
    service.crash();
    assert_eq!(service.status(id)["state"], "paused");
    assert_eq!(
        service.evaluations(id),
        paused["progress"]["evaluations"].as_u64()
    );

    assert_eq!(verb(&service, &["resume", "1"]), "calibration 1 is running\n");
    until("progress", || {
        service
            .evaluations(id)
            .filter(|n| Some(*n) > paused["progress"]["evaluations"].as_u64())
    });
    assert_eq!(verb(&service, &["cancel", "1"]), "calibration 1 is cancelled\n");
    assert_eq!(service.status(id)["state"], "cancelled");
    service.crash();
    assert_eq!(service.status(id)["state"], "cancelled");
    assert_eq!(service.metric("grouser_calibrations_in_hand"), 0);
    assert_eq!(service.act(1, "resume").status, 409);
    assert_eq!(service.status(other)["state"], "finished");
}

#[test]
fn events_tell_every_stage_once_and_end_with_the_calibration() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let mut reported: Vec<u64> = Vec::new();
    let mut states: Vec<String> = Vec::new();
    std::thread::scope(|scope| {
        let workers = scope.spawn(|| {
            let _worker = service.worker("worker", 1);
            service.wait_for(id, "finished");
        });
        let ended = service
            .client
            .events(&format!("/v1/calibrations/{id}/events"), |event, data| {
                let data: Value = serde_json::from_str(data).expect("JSON in an event");
                match event {
                    "stage" => reported.push(whole(&data["stage"])),
                    "status" => states.push(word(&data["state"]).to_owned()),
                    other => panic!("event {other}"),
                }
                true
            });
        assert!(ended);
        workers.join().expect("the calibration finishes");
    });
    let stages = service.result(id, "stages");
    let stages: Vec<u64> = items(&stages).filter_map(|s| s["stage"].as_u64()).collect();
    assert!(stages.len() > 3, "{stages:?}");
    assert_eq!(reported, stages);
    assert_eq!(states.last().map(String::as_str), Some("finished"));
    // A late listener gets the same events at once.
    let mut again = Vec::new();
    service
        .client
        .events(&format!("/v1/calibrations/{id}/events"), |event, data| {
            let data: Value = serde_json::from_str(data).expect("JSON in an event");
            again.extend((event == "stage").then(|| data["stage"].as_u64()).flatten());
            true
        });
    assert_eq!(again, stages);
}

#[test]
fn the_openapi_document_lists_every_route_of_the_contract() {
    let service = Service::start(&[]);
    let document = service.client.json("/openapi.json");
    let paths: BTreeMap<String, Vec<String>> = document["paths"]
        .as_object()
        .into_iter()
        .flatten()
        .map(|(path, methods)| {
            (
                path.clone(),
                methods
                    .as_object()
                    .map(|m| m.keys().cloned().collect())
                    .unwrap_or_default(),
            )
        })
        .collect();
    let calibration = "/v1/calibrations/{id}";
    let mut routes: Vec<(&str, String)> = vec![
        ("post", "/v1/experiments".into()),
        ("post", "/v1/calibrations".into()),
        ("get", "/v1/calibrations".into()),
        ("get", calibration.into()),
        ("get", "/v1/studies".into()),
        ("get", "/v1/studies/{id}".into()),
        ("post", "/v1/studies/{id}/runs".into()),
        ("get", "/v1/effects".into()),
        ("post", "/v1/effects".into()),
        ("get", "/v1/effects/{name}".into()),
        ("post", "/v1/work/exchange".into()),
        ("get", "/v1/work/variants/{hash}".into()),
        ("get", "/v1/workers".into()),
        ("get", "/metrics".into()),
        ("get", "/health".into()),
    ];
    routes.extend(
        ["cancel", "pause", "resume", "extend", "discovery"].map(|v| ("post", format!("{calibration}/{v}"))),
    );
    routes.extend(
        [
            "stages",
            "samples",
            "posterior",
            "comparison",
            "diagnostics",
            "histories",
            "flags",
            "summary",
            "figures",
            "events",
            "discovery",
        ]
        .map(|part| ("get", format!("{calibration}/{part}"))),
    );
    for (method, path) in routes {
        let methods = paths
            .get(&path)
            .unwrap_or_else(|| panic!("{path} is not in {:?}", paths.keys()));
        assert!(
            methods.iter().any(|m| m == method),
            "{method} {path}: {methods:?}"
        );
    }
    for (path, methods) in &paths {
        for method in methods {
            let operation = &document["paths"][path][method];
            let output = operation["summary"]
                .as_str()
                .or(operation["description"].as_str())
                .unwrap_or_default();
            assert!(!output.is_empty(), "{method} {path} says nothing");
        }
    }
}

#[test]
fn the_metrics_page_counts_what_happened() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let _worker = service.worker("worker", 2);
    service.wait_for(id, "finished");
    let summary = service.result(id, "summary");
    let sampled = whole(&summary["calibrations"][0]["evaluations"]);
    // The final draws, the best particle and the 60 of the population, each on fitted and on holdout runs; and the
    // likeliest one on the fitted ones.
    let completed = service.metric("grouser_evaluations_completed_total");
    assert_eq!(completed, sampled + 2 * 61 + 1);
    assert_eq!(service.metric("grouser_leases_given_total"), completed);
    assert_eq!(service.metric("grouser_leases_out"), 0);
    assert_eq!(service.metric("grouser_leases_failed_total"), 0);
    assert_eq!(service.metric("grouser_evaluations_duplicate_total"), 0);
    assert_eq!(service.metric("grouser_workers_connected"), 1);
    assert!(service.metric("grouser_store_facts_total") >= completed);
    let page = service.client.get("/metrics").body;
    for line in page.lines().filter(|line| !line.starts_with('#')) {
        let name = line.split([' ', '{']).next().unwrap_or_default();
        assert!(name.starts_with("grouser_"), "{line}");
        let parts = ["_total", "_bucket", "_count", "_sum"];
        let bare = parts
            .iter()
            .find_map(|part| name.strip_suffix(part))
            .unwrap_or(name);
        assert!(page.contains(&format!("# HELP {bare} ")), "{name}");
        assert!(page.contains(&format!("# TYPE {bare} ")), "{name}");
    }
}
