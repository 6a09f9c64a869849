//! `/health` answers while the service is busy, so that it is not restarted.

use farm_tests::fake_worker::{FakeWorker, evaluated};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::service::Service;
use farm_tests::wait::until_true;

#[test]
fn health_is_answered_in_the_middle_of_a_long_step_of_the_farm() {
    let service = Service::start(&[]);
    service.submit(&Job::small().sampler(20_000, [2, 4], 1));
    let worker = FakeWorker::new(&service.client, "worker");
    let step_s = || {
        let health = service.client.json("/health");
        assert_eq!(health["status"], "ok");
        health["farm_step_s"].as_f64().unwrap_or_default()
    };
    let outcome = |lease: &_| evaluated(lease, FIT_RUNS);
    // A worker that has answered nothing gets few leases.
    worker.answer(&worker.take(1), outcome);
    worker.answer(&worker.take(9_999), outcome);
    let last = worker.take(10_000);
    assert_eq!(last.len(), 10_000);
    // The exchange is answered after the sampler has proposed the next round.
    std::thread::scope(|scope| {
        let exchange = scope.spawn(|| worker.answer(&last, outcome));
        until_true("an answer in the middle of a step", || {
            let is_over = exchange.is_finished();
            let step_s = step_s();
            let is_in_the_middle = step_s > 0.2 && !exchange.is_finished();
            assert!(
                is_in_the_middle || !is_over,
                "the step is over, and nobody was told"
            );
            is_in_the_middle
        });
    });
    until_true("rest", || step_s() < 0.1);
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
