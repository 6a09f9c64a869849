//! Lease numbers: no number is given out twice, and a result counts once, for its own lease.

use std::time::{SystemTime, UNIX_EPOCH};

use farm_tests::assert_contains;
use farm_tests::fake_worker::{FakeWorker, evaluated, rejected};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::service::{Service, free_address};
use farm_tests::wait::until_true;

use super::numbers;

#[test]
fn fencing_tokens_never_repeat_across_restarts() {
    let mut service = Service::start(&[]);
    service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "token");
    let mut tokens = Vec::new();
    for _ in 0..3 {
        tokens.extend(numbers(&worker.take(5), "lease"));
        tokens.extend(numbers(&worker.take(5), "lease"));
        service.crash();
    }
    assert_eq!(tokens.len(), 30);
    assert!(tokens.windows(2).all(|pair| pair[0] < pair[1]), "{tokens:?}");
}

#[test]
fn a_late_result_from_before_a_restart_counts() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "patient");
    let leases = worker.take(4);
    service.crash();
    assert_eq!(
        worker.answer(&leases, |l| evaluated(l, FIT_RUNS))["duplicates"],
        0
    );
    assert_eq!(service.status(id)["progress"]["evaluations"], 4);
}

#[test]
fn a_result_sent_twice_counts_once() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "twice");
    let leases = worker.take(3);
    assert_eq!(
        worker.answer(&leases, |l| evaluated(l, FIT_RUNS))["duplicates"],
        0
    );
    assert_eq!(
        worker.answer(&leases, |l| evaluated(l, FIT_RUNS))["duplicates"],
        3
    );
    assert_eq!(service.status(id)["progress"]["evaluations"], 3);
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
    worker.answer(&leases[..1], |_| rejected());
    until_true("a differing duplicate noticed", || {
        service.metric("grouser_determinism_faults_total") == 1
    });
    assert_contains!(service.log(), "two workers returned different results");
}

#[test]
fn a_result_for_another_store_is_not_taken() {
    let address = free_address();
    let mut first = Service::start_at(address.clone(), &[]);
    first.submit(&Job::small());
    let worker = FakeWorker::new(&first.client, "wanderer");
    let leases = worker.take(2);
    first.kill();
    // Another job, another store, the same port; its first calibration has the same id. Not within one second:
    // nobody changes a store so fast, and the clock's seconds tell stores apart.
    let second_of = || {
        SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0, |d| d.as_secs())
    };
    let now = second_of();
    until_true("the next second", || second_of() > now);
    let second = Service::start_at(address, &[]);
    let id = second.submit(&Job::small().sampler(60, [2, 4], 2));
    let answer = worker.answer(&leases, |l| evaluated(l, FIT_RUNS));
    assert_eq!(answer["duplicates"], 2);
    assert_eq!(second.status(id)["progress"]["evaluations"], 0);
}
