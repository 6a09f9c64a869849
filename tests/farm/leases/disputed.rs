//! Two different answers to one evaluation.

use farm_tests::assert_contains;
use farm_tests::fake_worker::{FakeWorker, evaluated, rejected};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::service::Service;
use farm_tests::wait::until_true;
use serde_json::Value;

use super::worker_flags;

#[test]
fn an_answer_that_differs_leaves_a_flag_before_and_after_the_end_and_over_restarts() {
    let mut service = Service::start(&[]);
    let version = service.model_version();
    let id = service.submit(&Job::small());
    let first = FakeWorker::new(&service.client, "first").computing(&version);
    let leases = first.take(3);
    first.answer(&leases, |l| evaluated(l, FIT_RUNS));
    let faults = |count: u64| {
        until_true("differing answers noticed", || {
            service.metric("grouser_determinism_faults_total") == count
        });
    };
    first.answer(&leases[..1], |_| rejected());
    faults(1);
    let real = service.worker("real", 2);
    service.wait_for(id, "finished");
    drop(real);
    let flags = worker_flags(&service, id);
    assert_eq!(flags.len(), 1, "{flags:?}");
    assert_contains!(flags[0], "evaluation 0 was answered by worker first twice");
    // The summary is stored by now; an answer after the end still reaches it.
    first.answer(&leases[1..2], |_| rejected());
    faults(2);
    let flags = worker_flags(&service, id);
    assert_contains!(flags[0], "and 1 more");
    service.crash();
    assert_eq!(worker_flags(&service, id), flags);
    let shown: Vec<Value> = service.result(id, "flags").as_array().cloned().unwrap();
    assert_eq!(
        shown[0]["kind"], "worker",
        "it casts doubt on all others: {shown:?}"
    );
}
