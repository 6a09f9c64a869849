//! Workers in the middle of a long evaluation that are asked to stop, or whose connection halts.

use std::time::{Duration, Instant};

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::process::{Process, Signal};
use farm_tests::proxy::Proxy;
use farm_tests::service::Service;
use farm_tests::wait::until;

/// Returns a job whose evaluations take tens of seconds.
pub(super) fn long() -> Job {
    Job::small().in_job(
        "kind = \"quasi_static\"",
        "kind = \"scm\"\ndem_spacing_m = 0.008\ntravel_step_m = 0.0000005\nsteady_travel_m = 0.2",
    )
}

/// Waits until the only worker has begun the evaluation of a lease.
pub(super) fn begun(service: &Service) {
    until("a lease in hand", || {
        let holds = service.only_worker().and_then(|w| w["holds"].as_u64());
        holds.filter(|&holds| holds > 0)
    });
    // The evaluation begins as soon as the worker has the answer.
    std::thread::sleep(Duration::from_millis(200));
}

#[test]
fn a_worker_that_is_asked_to_stop_gives_a_long_evaluation_back() {
    let service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&long());
    let mut worker = service.worker("busy", 1);
    begun(&service);
    let signalled = Instant::now();
    worker.signal(Signal::Terminate);
    assert!(worker.wait().success(), "{}", worker.log());
    assert!(
        signalled.elapsed() < Duration::from_secs(10),
        "{:?}",
        signalled.elapsed()
    );
    assert_contains!(worker.log(), "unfinished=1");
    assert_eq!(service.metric("grouser_leases_out"), 0);
    assert_eq!(service.metric("grouser_leases_failed_total"), 0);
    assert_eq!(service.status(id)["state"], "running");
}

#[test]
fn leases_are_renewed_while_an_answer_hangs() {
    let service = Service::start(&["--lease-ms", "1500"]);
    let id = service.submit(&long());
    let (proxy, url) = Proxy::start(&service.client.0);
    let _worker = Process::worker(&url, 1, &service.folder().join("busy.log"));
    begun(&service);
    proxy.network().halt();
    let before = proxy.network().connections;
    // This is four times the time of a lease.
    std::thread::sleep(Duration::from_secs(6));
    assert!(
        proxy.network().connections > before,
        "the worker opened no other connection"
    );
    assert_eq!(service.metric("grouser_leases_out"), 1);
    assert_eq!(service.metric("grouser_leases_failed_total"), 0);
    assert_eq!(service.status(id)["state"], "running");
}
