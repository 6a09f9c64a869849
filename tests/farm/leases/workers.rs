//! The conditions for a lease: protocol, model version and waiting time.

use farm_tests::fake_worker::{FakeWorker, PROTOCOL, evaluated};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::wait::until_true;
use serde_json::json;

#[test]
fn another_protocol_is_refused_with_426() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "old");
    let mut request = worker.request();
    request["protocol"] = (PROTOCOL + 1).into();
    request["want"] = 1.into();
    let response = worker.send(&request);
    assert_eq!(response.status, 426);
    assert_eq!(response.json()["error"]["type"], "protocol_mismatch");
    assert_eq!(
        response.json()["error"]["message"],
        format!(
            "worker old speaks protocol {}, this coordinator {PROTOCOL}",
            PROTOCOL + 1
        )
    );
    assert_eq!(service.metric("grouser_leases_given_total"), 0);
}

#[test]
fn a_worker_of_another_model_version_gets_no_lease_and_is_told_why() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let wrong = FakeWorker::new(&service.client, "wrong").computing("no-such-version");
    assert_eq!(wrong.take(1).len(), 1);
    let first = FakeWorker::new(&service.client, "first");
    let leases = first.take(1);
    assert_eq!(
        service.status(id)["model_version"],
        json!(null),
        "a lease pins nothing"
    );
    first.answer(&leases, |l| evaluated(l, FIT_RUNS));
    assert_eq!(service.status(id)["model_version"], "fake-1");
    let other = FakeWorker::new(&service.client, "other").computing("fake-2");
    for restarted in [false, true] {
        if restarted {
            service.crash();
        }
        let mut request = other.request();
        request["want"] = 5.into();
        request["wait_ms"] = 30_000.into();
        let response = other.exchange(&request);
        assert_eq!(response["leases"], json!([]));
        let reported = "calibration 1 was begun with model version fake-1, worker other computes fake-2";
        assert_eq!(response["refused"], reported, "restarted: {restarted}");
    }
    assert_eq!(first.take(1).len(), 1);
}

#[test]
fn a_waiting_worker_is_served_when_work_arrives() {
    let service = Service::start(&[]);
    let worker = FakeWorker::new(&service.client, "waiting");
    let leases = std::thread::scope(|scope| {
        let poll = scope.spawn(|| {
            let mut request = worker.request();
            request["want"] = 4.into();
            request["wait_ms"] = 30_000.into();
            worker.exchange(&request)["leases"].as_array().map(Vec::len)
        });
        until_true("the waiting worker", || {
            service.metric("grouser_workers_connected") == 1
        });
        assert!(!poll.is_finished());
        service.submit(&Job::small());
        poll.join().expect("the poll ends")
    });
    assert_eq!(leases, Some(4));
}

#[test]
fn the_operator_says_which_version_computes_on_where_an_invented_one_was_first() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let invented = FakeWorker::new(&service.client, "liar").computing("no-such-version");
    let outcome = |lease: &_| evaluated(lease, FIT_RUNS);
    invented.answer(&invented.take(3), outcome);
    let honest = FakeWorker::new(&service.client, "honest");
    assert!(
        honest.take(3).is_empty(),
        "the first result has pinned the invented version"
    );
    let resume = |query: &str| {
        service
            .client
            .post(&format!("/v1/calibrations/{id}/resume{query}"), &json!({}))
    };
    assert_eq!(resume("?version=").status, 400);
    assert_eq!(resume("?version=fake-1&skip_faults=true").status, 400);
    let resumed = run(coordinator([
        "resume",
        &id.to_string(),
        "--version",
        "fake-1",
        "--url",
        &service.url(),
    ]));
    assert_eq!(resumed.success(), format!("calibration {id} is running\n"));
    until_true("leases for the chosen version", || !honest.take(3).is_empty());
    assert!(invented.take(3).is_empty());
    let status = service.status(id);
    assert_eq!(
        (&status["model_version"], &status["progress"]["evaluations"]),
        (&json!("fake-1"), &json!(0))
    );
}
