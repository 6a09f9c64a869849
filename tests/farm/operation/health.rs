//! `/health` answers while the service is busy, so that it is not restarted.

use farm_tests::fake_worker::{FakeWorker, evaluated};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::service::Service;
use farm_tests::wait::until_true;

#[test]
fn the_last_results_of_a_round_are_answered_before_the_next_one_is_computed() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small().sampler(20_000, [2, 4], 1));
    let worker = FakeWorker::new(&service.client, "worker");
    let outcome = |lease: &_| evaluated(lease, FIT_RUNS);
    // A worker that has answered nothing gets few leases.
    worker.answer(&worker.take(1), outcome);
    worker.answer(&worker.take(9_999), outcome);
    let last = worker.take(10_000);
    assert_eq!(last.len(), 10_000);
    // An answer behind the step would know of the evaluations of the next round.
    let answer = worker.answer(&last, outcome);
    assert_eq!(answer["remaining"], 0);
    let path = format!("/v1/calibrations/{id}");
    assert_eq!(service.client.json(&path)["progress"]["evaluations"], 20_000);
    assert_eq!(service.client.json("/health")["status"], "ok");
    until_true("the next round", || {
        service.client.json("/v1/work/demand")["queued"].as_u64() > Some(0)
    });
}

#[test]
fn polls_that_a_stop_ends_are_no_errors() {
    let mut service = Service::start(&[]);
    let worker = service.worker("idle", 1);
    until_true("a parked poll", || service.only_worker().is_some());
    assert!(service.terminate());
    let log = service.log();
    assert!(!log.contains("internal error"), "{log}");
    drop(worker);
}
