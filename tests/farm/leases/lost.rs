//! Workers that halt or leave with leases in hand.

use std::time::Duration;

use farm_tests::assert_contains;
use farm_tests::fake_worker::FakeWorker;
use farm_tests::job::Job;
use farm_tests::process::{Process, Signal};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::{until, until_true};
use serde_json::json;

/// Halts a worker at a moment at which it holds leases; returns their number.
fn halt_with_leases(service: &Service, worker: &Process) -> u64 {
    let holds = || service.only_worker().and_then(|w| w["holds"].as_u64());
    until("a worker halted with leases in hand", || {
        worker.signal(Signal::Stop);
        // Messages that it sent before the halt may still arrive.
        let before = holds();
        std::thread::sleep(Duration::from_millis(50));
        let holds = holds().filter(|&holds| holds > 0 && before == Some(holds));
        if holds.is_none() {
            worker.signal(Signal::Continue);
        }
        holds
    })
}

#[test]
fn a_halted_worker_loses_its_leases_and_its_late_results_change_nothing() {
    let job = Job::small().sampler(120, [2, 4], 5);
    let undisturbed = Service::start(&["--local-workers", "2"]);
    let expected = undisturbed.calibrate(&job);
    let expected = undisturbed.posterior_csv(expected);
    // A worker that is halted while it requests leases never receives them, and has no late results.
    let tried = (0..5).any(|_| late_results_change_nothing(&job, &expected));
    assert!(tried, "no worker was halted with leases it knew of");
}

/// Halts a worker until its calibration is finished without it; returns whether the worker then sent results.
fn late_results_change_nothing(job: &Job, expected: &str) -> bool {
    let service = Service::start(&["--lease-ms", "500"]);
    let id = service.submit(job);
    let mut halted = service.worker("halted", 2);
    // A worker that has not fetched its model variant yet would give its leases back.
    let evaluations = || service.status(id)["progress"]["evaluations"].as_u64();
    until_true("first results", || evaluations() > Some(0));
    let held = halt_with_leases(&service, &halted);
    assert!(evaluations() < Some(5000));
    let _other = service.worker("other", 2);
    service.wait_for(id, "finished");
    assert!(service.metric("grouser_leases_failed_total") >= held);
    let posterior = service.posterior_csv(id);
    same(&posterior, expected);

    let before = service.metric("grouser_evaluations_duplicate_total");
    halted.signal(Signal::Continue);
    let late = until("late results acknowledged as duplicates, or none", || {
        if service.metric("grouser_evaluations_duplicate_total") > before {
            return Some(true);
        }
        halted.log().contains("the coordinator is away").then_some(false)
    });
    assert!(halted.is_running());
    assert_eq!(service.status(id)["state"], "finished");
    same(&service.posterior_csv(id), &posterior);
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
    late
}

#[test]
fn sigterm_gives_leases_back_at_once() {
    // Leases last a minute, so that those which end sooner were given back.
    let service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&Job::small().sampler(400, [4, 10], 5));
    let mut worker = service.worker("leaving", 1);
    halt_with_leases(&service, &worker);
    worker.signal(Signal::Terminate);
    worker.signal(Signal::Continue);
    assert!(worker.wait().success(), "{}", worker.log());
    assert_eq!(service.only_worker().unwrap()["holds"], 0);
    assert_eq!(service.metric("grouser_leases_out"), 0);
    assert_eq!(service.metric("grouser_leases_failed_total"), 0);
    assert_contains!(worker.log(), "stopped");
    assert_eq!(service.status(id)["state"], "running");
}

#[test]
fn leases_are_renewed_by_holding_and_returned_without_cost() {
    let service = Service::start(&["--lease-ms", "1000"]);
    service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "holding");
    let leases = worker.take(2);
    let mut request = worker.request();
    request["holding"] = json!([leases[0]["lease"]]);
    // The lease that is not held expires, and the renewed one does not.
    until_true("an expired lease", || {
        worker.exchange(&request);
        service.metric("grouser_leases_failed_total") > 0
    });
    assert_eq!(service.metric("grouser_leases_out"), 1);
    request["holding"] = json!([]);
    request["returned"] = json!([leases[0]["lease"]]);
    worker.exchange(&request);
    assert_eq!(service.metric("grouser_leases_out"), 0);
    assert_eq!(service.metric("grouser_leases_failed_total"), 1);
}
