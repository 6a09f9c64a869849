//! Stores that were restored from a backup or copied: a result counts only for the question that it answers.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::fake_worker::{FakeWorker, evaluated};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::json::whole;
use farm_tests::service::Service;
use serde_json::Value;

/// Copies the file of a store with its write-ahead log over those at another place, as `cp` does.
fn copy(from: &Path, to: &Path) {
    for end in ["", "-wal"] {
        let at = |store: &Path| format!("{}{end}", store.display());
        // A store without a log is complete.
        if std::fs::copy(at(from), at(to)).is_err() {
            std::fs::remove_file(at(to)).ok();
        }
    }
}

/// Repeats the experiment with another seed, so that every parameter vector differs.
fn other_job() -> Job {
    Job::small().sampler(60, [2, 4], 2)
}

fn answer(worker: &FakeWorker, leases: &[Value]) -> u64 {
    let answer = worker.answer(leases, |l| evaluated(l, FIT_RUNS));
    whole(&answer["duplicates"])
}

fn evaluations(service: &Service, id: i64) -> u64 {
    service.status(id)["progress"]["evaluations"]
        .as_u64()
        .expect("a count")
}

#[test]
fn late_results_of_a_job_do_not_enter_the_job_that_gets_its_number_after_a_restore() {
    let mut service = Service::start(&[]);
    // The backup is made while the coordinator runs, so that it has the start of the coordinator that gives out the leases.
    let backup = service.folder().join("backup.db");
    copy(&service.store(), &backup);
    let first = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "late");
    let leases = worker.take(40);
    assert_eq!(leases.len(), 40);
    service.kill();
    copy(&backup, &service.store());
    service.restart();
    let second = service.submit(&other_job());
    assert_eq!(second, first, "the number is given out again");
    let fresh = FakeWorker::new(&service.client, "own").take(1);
    assert_ne!(fresh[0]["theta"], leases[0]["theta"]);
    assert_eq!(answer(&worker, &leases), 40);
    assert_eq!(evaluations(&service, second), 0);
    assert_eq!(service.metric("grouser_evaluations_refused_total"), 40);
    let log = service.log();
    let line = log.lines().find(|line| line.contains("results refused"));
    let line = line.unwrap_or_else(|| panic!("no line in\n{log}"));
    assert_contains!(line, "late", &leases[0]["lease"].to_string(), "40");
}

#[test]
fn late_results_of_a_job_that_a_restore_brings_back_count() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "late");
    let backup = service.folder().join("backup.db");
    copy(&service.store(), &backup);
    let leases = worker.take(8);
    service.kill();
    copy(&backup, &service.store());
    service.restart();
    assert_eq!(answer(&worker, &leases), 0, "the same questions of the same job");
    assert_eq!(evaluations(&service, id), 8);
}

#[test]
fn a_result_under_a_version_that_the_restored_store_does_not_know_is_refused() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let backup = service.folder().join("backup.db");
    copy(&service.store(), &backup);
    let leases = FakeWorker::new(&service.client, "early").take(2);
    service.kill();
    copy(&backup, &service.store());
    service.restart();
    let newer = FakeWorker::new(&service.client, "newer").computing("fake-2");
    let pinning = newer.take(1);
    assert_eq!(answer(&newer, &pinning), 0, "pins another version");
    assert_eq!(answer(&FakeWorker::new(&service.client, "early"), &leases), 2);
    assert_eq!(evaluations(&service, id), 1);
}

#[test]
fn two_copies_of_a_store_take_nothing_of_each_others_new_jobs() {
    let mut original = Service::start(&[]);
    let mut other = Service::start(&[]);
    other.kill();
    copy(&original.store(), &other.store());
    other.restart();
    let (here, there) = (original.submit(&Job::small()), other.submit(&other_job()));
    assert_eq!(here, there);
    let leases = FakeWorker::new(&original.client, "wanderer").take(5);
    let wanderer = FakeWorker::new(&other.client, "wanderer");
    wanderer.take(1);
    assert_eq!(answer(&wanderer, &leases), 5);
    assert_eq!(evaluations(&other, there), 0);
    // Moving the store changes nothing.
    original.kill();
    let moved = original.folder().join("moved.db");
    copy(&original.store(), &moved);
    copy(&moved, &original.store());
    original.restart();
    assert_eq!(answer(&FakeWorker::new(&original.client, "wanderer"), &leases), 0);
}

#[test]
fn one_lease_answers_one_evaluation_and_only_from_its_own_worker() {
    let service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&Job::small());
    let honest = FakeWorker::new(&service.client, "honest");
    let liar = FakeWorker::new(&service.client, "liar");
    let spent = liar.take(1);
    assert_eq!(answer(&liar, &spent), 0);
    let leases = honest.take(10);
    // The liar uses one spent lease number for ten evaluations, with its own seal and with the seals of the other worker.
    let forged: Vec<Value> = leases
        .iter()
        .flat_map(|lease| {
            let mut own_seal = lease.clone();
            (own_seal["lease"], own_seal["seal"]) = (spent[0]["lease"].clone(), spent[0]["seal"].clone());
            let mut own_number = lease.clone();
            own_number["lease"] = spent[0]["lease"].clone();
            [own_seal, own_number, lease.clone()]
        })
        .collect();
    assert_eq!(answer(&liar, &forged), 30);
    assert_eq!(evaluations(&service, id), 1);
    // A worker cannot return the leases of another worker.
    let mut request = liar.request();
    request["returned"] = leases.iter().map(|lease| lease["lease"].clone()).collect();
    liar.exchange(&request);
    assert_eq!(service.metric("grouser_leases_out"), 10);
    assert_eq!(answer(&honest, &leases), 0);
    assert_eq!(evaluations(&service, id), 11);
}
