//! Results that a second worker computes as well.

use farm_tests::assert_contains;
use farm_tests::fake_worker::{FakeWorker, evaluated, rejected};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::json::whole;
use farm_tests::lying_proxy::LyingProxy;
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::{until, until_true};

use super::worker_flags;

fn job() -> Job {
    Job::small().sampler(300, [4, 8], 5)
}

/// Returns the results of honest workers.
fn honest(job: &Job) -> String {
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.calibrate(job);
    service.posterior_csv(id)
}

/// Calibrates with a worker that begins to lie after some results, and with two honest workers. The posterior must have the bytes of honest
/// workers, and the flags must name the liar.
fn survives_a_liar(job: &Job, honest_results: usize, verify_percent: &str) {
    let service = Service::start(&["--verify-percent", verify_percent]);
    let proxy = LyingProxy::start(&service.client.0, honest_results, 3);
    let mut liar = service.json_worker_at(&proxy.url(), "liar");
    let id = service.submit(job);
    until("the liar's first results", || {
        let done = service.evaluations(id)?;
        (done as usize > honest_results / 4).then_some(())
    });
    let _others = ["a", "b"].map(|name| service.worker(name, 1));
    service.wait_for(id, "finished");
    assert!(proxy.lies() > 0);
    same(&service.posterior_csv(id), &honest(job));
    let flags = worker_flags(&service, id);
    assert_eq!(flags.len(), 1, "{flags:?}");
    assert_contains!(
        flags[0],
        "computes wrongly and was quarantined",
        "computed again by others"
    );
    assert_eq!(service.metric("grouser_workers_quarantined"), 1);
    assert!(service.metric("grouser_evaluations_confirmed_total") > 20);
    let workers = service.client.json("/v1/workers");
    let quarantined: Vec<&str> = workers
        .as_object()
        .expect("workers")
        .values()
        .filter_map(|worker| worker["quarantined"].as_str())
        .collect();
    assert_eq!(quarantined.len(), 1, "{workers}");
    assert!(quarantined[0].contains("is contradicted"), "{workers}");
    assert!(
        liar.is_running(),
        "it is told why it gets nothing:\n{}",
        liar.log()
    );
    until_true("a refusal in the liar's log", || {
        liar.log().contains("computes wrongly and is quarantined")
    });
}

#[test]
fn a_worker_that_begins_to_lie_is_found_and_changes_no_byte() {
    // Some 150 lies follow. The chance that none of them is among the 20 % that another worker computes as well is below 1e-13.
    survives_a_liar(&job(), 300, "20");
}

#[test]
fn two_workers_that_disagree_leave_a_flag_where_there_is_no_third() {
    let service = Service::start(&["--verify-percent", "1"]);
    let version = service.model_version();
    let id = service.submit(&Job::small());
    let liar = FakeWorker::new(&service.client, "liar").computing(&version);
    liar.answer(&liar.take(2), |lease| evaluated(lease, FIT_RUNS));
    let _real = service.worker("real", 2);
    service.wait_for(id, "finished");
    let flags = worker_flags(&service, id);
    assert!(flags.len() == 1, "{flags:?}");
    assert!(
        flags[0].contains("no number of this calibration can be trusted"),
        "{flags:?}"
    );
}

#[test]
fn a_worker_that_contradicts_itself_needs_no_third() {
    let service = Service::start(&["--verify-percent", "1"]);
    let version = service.model_version();
    let id = service.submit(&Job::small());
    let liar = FakeWorker::new(&service.client, "liar").computing(&version);
    let leases = liar.take(2);
    liar.answer(&leases, |lease| evaluated(lease, FIT_RUNS));
    liar.answer(&leases[..1], |_| rejected());
    assert!(liar.take(1).is_empty(), "quarantined");
    let _real = service.worker("real", 2);
    service.wait_for(id, "finished");
    let flags = worker_flags(&service, id);
    assert!(
        flags.len() == 1
            && flags[0].contains("2 results of it, and what followed from them, were computed again"),
        "{flags:?}"
    );
    same(&service.posterior_csv(id), &honest(&Job::small()));
}

#[test]
fn with_one_worker_nothing_is_verified_and_that_is_said() {
    let mut service = Service::start(&["--verify-percent", "5"]);
    let id = service.submit(&Job::small());
    let worker = service.worker("only", 2);
    service.wait_for(id, "finished");
    let verification = |service: &Service, id: i64| {
        let diagnostics = service.result(id, "diagnostics");
        ["confirmed", "workers"].map(|key| whole(&diagnostics["verification"][key]))
    };
    assert_eq!(verification(&service, id), [0, 1]);
    assert!(service.metric("grouser_evaluations_unconfirmed_total") > 5);
    drop(worker);

    // A result of one worker waits for a second worker, even over a restart.
    let id = service.submit(&job());
    let worker = service.worker("first", 1);
    until("some results", || (service.evaluations(id)? > 300).then_some(()));
    service.kill();
    drop(worker);
    service.restart();
    let _second = service.worker("second", 1);
    service.wait_for(id, "finished");
    let [confirmed, workers] = verification(&service, id);
    assert!(confirmed > 0 && workers == 2, "{confirmed} {workers}");
}

#[test]
fn what_a_slow_worker_holds_at_the_end_of_a_round_goes_to_another_as_well() {
    let service = Service::start(&["--lease-ms", "600000"]);
    let version = service.model_version();
    let id = service.submit(&Job::small());
    let slow = FakeWorker::new(&service.client, "slow").computing(&version);
    slow.start(&slow.take(1));
    let _real = service.worker("real", 1);
    // Without a second lease the first round would end after ten minutes.
    service.wait_for(id, "finished");
}
