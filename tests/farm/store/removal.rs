//! Studies that are archived, restored, deleted, and deleted by age.

use farm_tests::assert_contains;
use farm_tests::fake_worker::{FakeWorker, rejected};
use farm_tests::job::Job;
use farm_tests::programs::{Ended, coordinator, run};
use farm_tests::service::Service;
use farm_tests::wait::until_true;
use serde_json::{Value, json};

fn verb(service: &Service, verb: &str, study: &str) -> Ended {
    run(coordinator([verb, study, "--url", &service.url()]))
}

fn numbers(list: &Value) -> Vec<i64> {
    let lines = list.as_array().expect("a list").iter();
    lines.map(|line| line["id"].as_i64().expect("a number")).collect()
}

#[test]
fn a_deleted_study_is_gone_with_its_rows_and_its_numbers_are_not_given_out_again() {
    let mut service = Service::start(&["--local-workers", "2"]);
    let kept = service.submit(&Job::small());
    let deleted = service.submit(&Job::small());
    for id in [kept, deleted] {
        service.wait_for(id, "finished");
    }
    service.part(deleted, "report");
    let output = verb(&service, "delete", "2").success();
    assert_eq!(output, "study 2 is deleted, with its calibrations: 2\n");
    assert_contains!(service.log(), "deleted study=2");
    assert_eq!(numbers(&service.client.json("/v1/calibrations")), [kept]);
    for path in [
        "/v1/studies/2",
        "/v1/calibrations/2",
        "/v1/calibrations/2/summary",
    ] {
        assert_eq!(service.client.get(path).status, 404, "{path}");
    }
    assert_eq!(verb(&service, "delete", "2").refusal(), "there is no study 2");
    assert_eq!(service.part(1, "summary").status, 200);
    assert_eq!(service.submit(&Job::small()), 3);
    service.wait_for(3, "finished");
    service.terminate();
    let mut database = service.database();
    let left = database.number(
        "SELECT (SELECT count(*) FROM evaluations WHERE calibration = 2) + (SELECT count(*) FROM samples WHERE calibration = 2)
         + (SELECT count(*) FROM results WHERE study = 2) + (SELECT count(*) FROM experiments WHERE id = 2)",
    );
    assert_eq!(left, 0);
    assert_eq!(database.number("SELECT max(id) FROM experiments"), 3);
}

#[test]
fn a_deletion_that_was_cut_short_is_finished_at_the_next_start() {
    let mut service = Service::start(&["--local-workers", "2"]);
    service.submit(&Job::small());
    service.wait_for(1, "finished");
    service.terminate();
    // This is the state after the first part of a deletion, with a row of an external model that was asked twice.
    service.database().execute(
        "INSERT INTO repeats VALUES (1, 1, 1, false, 0, 0, 0, 0);
         INSERT INTO deletions VALUES (1, 1, 1, 0); UPDATE studies SET archived_at_ms = 0;
         DELETE FROM evaluations WHERE evaluation < 50",
    );
    service.restart();
    until_true("the rest of the deletion", || {
        service.client.get("/v1/studies/1").status == 404
    });
    assert_eq!(service.submit(&Job::small()), 2);
}

#[test]
fn a_study_in_progress_is_neither_deleted_nor_archived_and_late_results_of_a_deleted_one_are_harmless() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "late");
    let leases = worker.take(2);
    for what in ["delete", "archive"] {
        let message = verb(&service, what, "1").refusal();
        let expected = format!(
            "calibration {id} of study 1 is running; the study cannot be {what}d: wait, or cancel it first"
        );
        assert_eq!(message, expected);
    }
    assert_eq!(
        service
            .client
            .send("DELETE", "/v1/studies/1", None)
            .expect("an answer")
            .status,
        409
    );
    service.act(1, "cancel");
    verb(&service, "delete", "1").success();
    worker.answer(&leases, |_| rejected());
    assert_eq!(service.submit(&Job::small()), 2);
    assert_eq!(service.client.get("/health").status, 200);
}

#[test]
fn an_archived_study_is_out_of_the_lists_readable_and_does_not_grow() {
    let service = Service::start(&["--local-workers", "2"]);
    service.submit(&Job::small());
    service.wait_for(1, "finished");
    assert_eq!(verb(&service, "archive", "1").success(), "study 1 is archived\n");
    assert_eq!(service.client.json("/v1/calibrations"), json!([]));
    assert_eq!(service.client.json("/v1/studies"), json!([]));
    assert_eq!(
        numbers(&service.client.json("/v1/calibrations?archived=true")),
        [1]
    );
    assert_eq!(
        service.client.json("/v1/studies?archived=true")[0]["archived"],
        true
    );
    let list =
        |more: &[&str]| run(coordinator([&["list", "--url", &service.url()], more].concat())).success();
    assert!(!list(&[]).contains("finished"));
    assert!(list(&["--archived"]).contains("finished"));
    assert_eq!(service.part(1, "report").status, 200);
    let grown = service
        .client
        .post("/v1/calibrations/1/extend", &json!({"effect": "janosi_hanamoto"}));
    assert_eq!(grown.status, 409);
    assert_contains!(grown.body, "study 1 is archived: restore it first");
    verb(&service, "restore", "1").success();
    assert_eq!(numbers(&service.client.json("/v1/studies")), [1]);
}

#[test]
fn archived_studies_are_deleted_by_age_where_the_operator_says_so_and_others_never() {
    let mut service = Service::start(&["--local-workers", "2", "--keep-days", "30"]);
    for id in 1..=3 {
        service.submit(&Job::small());
        service.wait_for(id, "finished");
    }
    for study in ["1", "2"] {
        verb(&service, "archive", study).success();
    }
    service.terminate();
    service
        .database()
        .execute("UPDATE studies SET archived_at_ms = archived_at_ms - 2678400000 WHERE id = 1");
    service.restart();
    until_true("the deletion of what is too old", || {
        service.client.get("/v1/studies/1").status == 404
    });
    assert_eq!(numbers(&service.client.json("/v1/studies?archived=true")), [2, 3]);
    assert_contains!(service.log(), "archived 30 days ago");
}
