//! An unreadable row stops its own calibration with a message, and no other calibration.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{item_count, word};
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use serde_json::Value;

/// Returns two calibrations, of which the first is spoilt by a statement while the service is away.
fn spoilt(sql: &'static str) -> (Service, Value) {
    let mut service = Service::start(&[]);
    let bad = service.submit(&Job::small());
    let good = service.submit(&Job::small());
    service.terminate();
    service.database().execute(sql);
    service.restart();
    let worker = service.worker("worker", 2);
    service.wait_for(good, "finished");
    drop(worker);
    let status = service.status(bad);
    let list = service.client.json("/v1/calibrations");
    assert_eq!(item_count(&list), 2, "{list}");
    assert_eq!(list[0], status);
    (service, status)
}

#[track_caller]
fn says(status: &Value, part: &str) {
    let message = word(&status["message"]);
    assert!(message.contains(part), "{status} lacks {part:?}");
}

#[test]
fn an_evaluation_without_a_whole_parameter_vector_pauses_its_calibration_with_its_number() {
    let (service, status) = spoilt(
        "INSERT INTO evaluations (calibration, evaluation, theta, log_likelihood, fitted, fingerprint, worker)
         VALUES (1, 3, x'0001020304', -1.5, x'', 0, 'worker')",
    );
    assert_eq!(status["state"], "paused");
    says(&status, "calibration 1, evaluation 3: ");
    says(&status, "5 bytes");
    let log = service.log();
    assert_contains!(log, "not resumed", "evaluation 3");
    for verb in ["resume", "pause"] {
        let answer = service.act(1, verb);
        assert_eq!(answer.status, 409);
        assert_contains!(answer.body, "evaluation 3");
    }
}

#[test]
fn a_value_of_another_type_is_a_bad_row_and_no_panic() {
    let (service, status) = spoilt("UPDATE calibrations SET busy_ms = 'long' WHERE id = 1");
    says(&status, "busy_ms");
    assert!(!service.log().contains("panicked"), "{}", service.log());
    let list = run(coordinator(["list", "--url", &service.url()])).success();
    assert_contains!(list, "busy_ms");
}

#[test]
fn a_key_that_is_no_key_stops_its_calibration_alone() {
    let (_service, status) = spoilt("UPDATE calibrations SET seal_key = x'00' WHERE id = 1");
    says(&status, "the seal key of calibration 1 is not 16 bytes");
}
