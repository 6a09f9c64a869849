//! The moves of a metamodel give the same bytes on any workers, and after any kill of the coordinator.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::whole;
use farm_tests::programs;
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;
use serde_json::Value;

fn job() -> Job {
    let moves = "moves = [2, 4]\nmetamodel_moves = 8";
    Job::rolling()
        .sampler(40, [2, 4], 5)
        .in_job("moves = [2, 4]", moves)
}

/// Returns the posterior, and what the summary says of metamodel and evaluations.
fn finished(service: &Service, id: i64) -> (String, [Value; 2]) {
    service.wait_for(id, "finished");
    let summary = service.result(id, "summary");
    let calibration = &summary["calibrations"][0];
    let counts = ["metamodel", "evaluations"].map(|key| calibration[key].clone());
    (service.posterior_csv(id), counts)
}

#[test]
fn subchains_give_the_same_bytes_on_any_worker_and_over_a_restart() {
    let alone = Service::start(&[]);
    let id = alone.submit(&job());
    let _worker = alone.worker("alone", 1);
    let (expected, counts) = finished(&alone, id);
    let [metamodel, evaluations] = counts.each_ref();
    let count = |key: &str| whole(&metamodel[key]);
    assert!(count("moved") > 50, "{metamodel}");
    assert!(count("moved") < count("subchains"), "none stayed: {metamodel}");
    // A subchain has eight moves, unless it starts where the quasi-static model has no solution.
    assert!(count("moves") > 7 * count("subchains"), "{metamodel}");
    assert!(count("moves") <= 8 * count("subchains"), "{metamodel}");
    assert!(
        count("moved") < evaluations.as_u64().expect("a count"),
        "{evaluations}"
    );

    let mut service = Service::start(&["--lease-ms", "500", "--verify-percent", "20"]);
    let id = service.submit(&job());
    let _workers = ["a", "b"].map(|name| service.worker(name, 2));
    for evaluations in [60, 100, 170] {
        until("progress", || {
            let status = service.status(id);
            (status["progress"]["evaluations"].as_u64()? >= evaluations || status["state"] == "finished")
                .then_some(())
        });
        service.crash();
    }
    let (posterior, again) = finished(&service, id);
    same(&posterior, &expected);
    assert_eq!(again, counts);
}

#[test]
fn the_quasi_static_model_needs_no_metamodel_and_is_told_so() {
    let folder = tempfile::tempdir().unwrap();
    let moves = "moves = [2, 4]\nmetamodel_moves = 8";
    let path = Job::small().in_job("moves = [2, 4]", moves).write(folder.path());
    let error = programs::run(programs::coordinator(["check".as_ref(), path.as_os_str()])).refusal();
    assert_contains!(
        error,
        "metamodel_moves under [sampler]: the metamodel is made of quasi_static"
    );
}

#[test]
fn what_the_quasi_static_model_cannot_express_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let prior = "[priors]\nflow_fraction = { uniform = [0.1, 0.4] }";
    let path = job().in_job("[priors]", prior).write(folder.path());
    let error = programs::run(programs::coordinator(["check".as_ref(), path.as_os_str()])).refusal();
    assert_contains!(error, "flow_fraction: quasi_static has no terrain that deforms");
}
