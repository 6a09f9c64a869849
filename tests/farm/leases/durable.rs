//! Acknowledged means durable: what was answered outlives a kill at once after the answer.

use farm_tests::fake_worker::{FakeWorker, evaluated, rejected};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::service::Service;
use serde_json::json;

#[test]
fn acknowledged_results_outlive_a_kill() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small().sampler(400, [2, 4], 1));
    let worker = FakeWorker::new(&service.client, "acknowledged");
    for round in 1..=8 {
        let leases = worker.take(40);
        let outcome = |l: &serde_json::Value| {
            if l["evaluation"].as_u64().is_some_and(|e| e % 4 == 0) {
                rejected()
            } else {
                evaluated(l, FIT_RUNS)
            }
        };
        assert_eq!(worker.answer(&leases, outcome)["duplicates"], 0);
        service.crash();
        let progress = service.status(id)["progress"].clone();
        assert_eq!(
            progress["evaluations"].as_u64(),
            Some(40 * round),
            "round {round}"
        );
        assert_eq!(progress["rejected"].as_u64(), Some(10 * round), "round {round}");
    }
}

#[test]
fn acknowledged_jobs_and_commands_outlive_a_kill() {
    let mut service = Service::start(&[]);
    for id in 1..=5 {
        assert_eq!(service.submit(&Job::small()), id);
        service.crash();
        assert_eq!(service.status(id)["state"], "queued");
        for (verb, state) in [
            ("pause", "paused"),
            ("resume", "running"),
            ("cancel", "cancelled"),
        ] {
            let answer = service.act(id, verb);
            assert_eq!(answer.json(), json!({"state": state}));
            service.crash();
            // Nothing has been leased, so what runs is queued again.
            let expected = if state == "running" { "queued" } else { state };
            assert_eq!(service.status(id)["state"], expected, "{verb}");
        }
    }
}
