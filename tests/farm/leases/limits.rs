//! Workers that end without being asked to, as pilots of a queue do.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::process::{Process, Signal};
use farm_tests::programs::line;
use farm_tests::service::Service;
use farm_tests::wait::until;

use super::busy::{begun, long};

/// Returns a worker of one thread with limits.
fn start(service: &Service, more: &[&str]) -> Process {
    service.worker_with("limited", 1, more)
}

#[test]
fn one_that_has_nothing_to_do_ends_after_its_time() {
    let service = Service::start(&[]);
    let mut idle = start(&service, &["--max-idle", "0.5"]);
    assert!(idle.wait().success(), "{}", idle.log());
    assert_contains!(idle.log(), "--max-idle");
}

#[test]
fn one_whose_coordinator_does_not_come_back_ends_with_what_it_has_computed() {
    let mut service = Service::start(&[]);
    service.submit(&Job::small().sampler(5000, [2, 4], 1));
    let mut left = start(&service, &["--max-idle", "2"]);
    until("some evaluations", || {
        service.evaluations(1).filter(|&done| done >= 64)
    });
    service.kill();
    assert!(left.wait().success(), "{}", left.log());
    assert_contains!(left.log(), "--max-idle");
}

#[test]
fn one_that_serves_once_ends_when_nothing_is_left() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let mut once = start(&service, &["--once"]);
    assert!(once.wait().success(), "{}", once.log());
    assert_eq!(service.status(id)["state"], "finished");
    assert_contains!(once.log(), "no calibration wants workers");
}

#[test]
fn the_end_of_a_lifetime_and_sigusr1_give_back_what_is_begun_and_blame_nobody() {
    for early in [false, true] {
        let service = Service::start(&["--lease-ms", "60000"]);
        let id = service.submit(&long());
        let more: &[&str] = if early { &[] } else { &["--max-lifetime", "3"] };
        let mut limited = start(&service, more);
        begun(&service);
        if early {
            limited.signal(Signal::User);
        }
        assert!(limited.wait().success(), "{}", limited.log());
        assert_eq!(service.metric("grouser_leases_out"), 0);
        assert_eq!(service.metric("grouser_leases_failed_total"), 0);
        assert_eq!(service.status(id)["state"], "running");
    }
}

#[test]
fn a_queue_learns_from_the_status_whether_to_start_another() {
    let service = Service::start(&[]);
    let mut large = start(&service, &["--max-memory-mb", "1"]);
    assert_eq!(large.wait().code(), Some(75), "{}", large.log());
    let mut refused = Process::worker(
        &format!("{}/nowhere", service.url()),
        1,
        &service.folder().join("refused.log"),
    );
    assert_eq!(refused.wait().code(), Some(69), "{}", refused.log());
}

#[test]
fn the_job_of_the_queue_stands_in_the_list_of_workers() {
    let service = Service::start(&[]);
    let mut command = line("worker --coordinator {} --threads 1", &[&service.url()]);
    command
        .env("SLURM_ARRAY_JOB_ID", "1234")
        .env("SLURM_ARRAY_TASK_ID", "5");
    let _worker = Process::start(command, &service.folder().join("queued.log"));
    let record = until("the worker", || service.only_worker());
    assert_eq!(record["queue_job"], "slurm 1234_5");
    assert_eq!(record["threads"], 1);
}
