//! The results of a finished study are computed once, and again when the study has changed.

use farm_tests::job::Job;
use farm_tests::json::item_count;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until_true;
use farm_tests::workspace::text;
use serde_json::Value;

fn ledger(summary: &str) -> usize {
    let summary: Value = serde_json::from_str(summary).expect("JSON");
    summary["calibrations"].as_array().expect("a ledger").len()
}

#[test]
fn a_rerun_shows_the_same_and_a_study_that_has_grown_shows_what_was_added() {
    let temporary = tempfile::tempdir().expect("a folder");
    let job = Job::small()
        .write(&temporary.path().join("sand"))
        .display()
        .to_string();
    let out = temporary.path().join("out").display().to_string();
    let command = |words: &[&str]| run(coordinator(words.iter().chain(&["--out", &out]))).success();
    let file = |name: &str| text(&temporary.path().join("out").join(name));
    let first = command(&["run", &job]);
    let (summary, report) = (file("summary.json"), file("report.html"));
    let diagnosed = command(&["diagnose", "1"]);
    // The command writes lost results again.
    std::fs::remove_file(temporary.path().join("out").join("summary.json")).expect("a file");
    same(&command(&["run", &job]), &first);
    same(&file("summary.json"), &summary);
    same(&command(&["report"]), &report);
    assert_eq!(ledger(&summary), 1);

    command(&["extend", "1", "--effect", "slip_sinkage"]);
    assert_eq!(ledger(&file("summary.json")), 2);
    let grown = file("report.html");
    assert!(grown != report && grown.contains("slip_sinkage"));
    same(&command(&["report"]), &grown);
    // The first calibration and its diagnostics have not changed.
    same(&command(&["diagnose", "1"]), &diagnosed);
    assert!(command(&["diagnose", "2"]) != diagnosed);
}

#[test]
fn a_service_shows_a_study_while_it_runs_and_what_it_has_become() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let summary = format!("/v1/calibrations/{id}/summary");
    assert_eq!(
        service.client.get(&summary).status,
        409,
        "nothing is finished yet"
    );
    let _worker = service.worker("worker", 2);
    service.wait_for(id, "finished");
    let first = service.client.json(&summary);
    assert_eq!(first["status"], "finished");
    assert_eq!(service.client.json(&summary), first);
    let extension = serde_json::json!({"effect": "slip_sinkage"});
    let created = service
        .client
        .post(&format!("/v1/calibrations/{id}/extend"), &extension)
        .json();
    let added = created["id"].as_i64().expect("an id");
    // Until the addition is finished, the study is unfinished and its stored end is not shown.
    let between = service.client.json(&summary);
    assert!(between["status"] != "finished" || between["calibrations"].as_array().map(Vec::len) == Some(2));
    service.wait_for(added, "finished");
    let grown = service.client.json(&summary);
    assert_eq!(item_count(&grown["calibrations"]), 2);
    service.crash();
    assert_eq!(service.client.json(&summary), grown);
    let flags = service.result(id, "flags");
    let diagnostics = service.result(id, "diagnostics");
    assert_eq!(diagnostics["flags"], flags);
}

#[test]
fn stored_diagnostics_and_flags_are_handed_on_as_they_stand() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let _worker = service.worker("worker", 2);
    service.wait_for(id, "finished");
    let [diagnostics, flags] = ["diagnostics", "flags"].map(|part| format!("/v1/calibrations/{id}/{part}"));
    let first = service.client.get(&diagnostics);
    assert_eq!(first.status, 200, "{}", first.body);
    let mut database = service.database();
    let stored = format!("SELECT body FROM results WHERE name = 'diagnostics-{id}.json'");
    assert_eq!(database.text(&stored), first.body);
    // A restart ends a concurrent computation of the overview, which could replace the stored text.
    assert!(service.terminate());
    service.restart();
    // The program would not write this text itself, so that the answer must be the stored text.
    let marked = r#"{"flags": [ {"marked": 1.50} ], "more": 2}"#;
    database.execute(&format!(
        "UPDATE results SET body = '{marked}' WHERE name = 'diagnostics-{id}.json'"
    ));
    assert_eq!(service.client.get(&diagnostics).body, marked);
    let answer = service.client.get(&flags);
    assert_eq!(answer.body, r#"[ {"marked": 1.50} ]"#);
    assert_eq!(answer.header("content-type"), Some("application/json"));
}

#[test]
fn the_list_of_studies_reads_the_lines_that_are_stored() {
    let mut service = Service::start(&["--local-workers", "2"]);
    service.calibrate(&Job::small());
    until_true("the line of the study", || {
        let error = service.client.json("/v1/studies")[0]["error"].clone();
        !error.is_null()
    });
    assert!(service.terminate());
    // The program would not write this line itself, so that the list must show the stored line.
    let marked = r#"replace(body, '"effects":[]', '"effects":["marked"]')"#;
    service.database().execute(&format!(
        "UPDATE results SET body = {marked} WHERE name = 'list_item.json'"
    ));
    service.restart();
    assert_eq!(
        service.client.json("/v1/studies")[0]["effects"],
        serde_json::json!(["marked"])
    );
}

#[test]
fn what_was_cancelled_has_no_results_and_says_so() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let cancel = service.act(id, "cancel");
    assert_eq!(cancel.status, 200);
    for result in ["summary", "report", "diagnostics", "flags"] {
        let answer = service.client.get(&format!("/v1/calibrations/{id}/{result}"));
        assert_eq!(answer.status, 409, "{result}: {}", answer.body);
    }
}
