//! Workers that end by themselves, as those do that a queue has started.

use std::process::Command;

use farm_tests::job::Job;
use farm_tests::process::{Process, Signal};
use farm_tests::programs;
use farm_tests::service::Service;
use farm_tests::wait::until;

use super::busy::{begun, long};

/// A worker of one thread with limits.
fn worker(service: &Service, more: &[&str]) -> Command {
    let url = format!("http://{}", service.client.0);
    let words = ["--coordinator", &url, "--threads", "1"];
    programs::worker(words.into_iter().chain(more.iter().copied()))
}

fn start(service: &Service, more: &[&str]) -> Process {
    Process::start(worker(service, more), &service.folder().join("limited.log"))
}

#[test]
fn one_that_has_nothing_to_do_ends_after_its_time() {
    let service = Service::start(&[]);
    let mut idle = start(&service, &["--max-idle", "0.5"]);
    assert!(idle.wait().success(), "{}", idle.log());
    assert!(idle.log().contains("--max-idle"), "{}", idle.log());
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
    assert!(left.log().contains("--max-idle"), "{}", left.log());
}

#[test]
fn one_that_serves_once_ends_when_nothing_is_left() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let mut once = start(&service, &["--once"]);
    assert!(once.wait().success(), "{}", once.log());
    assert_eq!(service.status(id)["state"], "finished");
    assert!(
        once.log().contains("no calibration wants workers"),
        "{}",
        once.log()
    );
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
    let nowhere = format!("http://{}/nowhere", service.client.0);
    let refused = programs::worker(["--coordinator", &nowhere, "--threads", "1"]);
    let mut refused = Process::start(refused, &service.folder().join("refused.log"));
    assert_eq!(refused.wait().code(), Some(69), "{}", refused.log());
}

#[test]
fn the_job_of_the_queue_stands_in_the_list_of_workers() {
    let service = Service::start(&[]);
    let mut command = worker(&service, &[]);
    command
        .env("SLURM_ARRAY_JOB_ID", "1234")
        .env("SLURM_ARRAY_TASK_ID", "5");
    let _worker = Process::start(command, &service.folder().join("queued.log"));
    let known = until("the worker", || service.only_worker());
    assert_eq!(
        (&known["queue_job"], &known["threads"]),
        (&"slurm 1234_5".into(), &1.into())
    );
}
