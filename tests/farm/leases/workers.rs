//! The conditions for a lease: protocol, model version and waiting time.

use farm_tests::fake_worker::{FakeWorker, PROTOCOL, evaluated};
use farm_tests::job::{FIT_RUNS, Job};
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
