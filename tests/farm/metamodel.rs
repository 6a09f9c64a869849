//! A metamodel's moves are part of a calibration like any other: the same bytes whoever takes them, whatever dies.

use farm_tests::job::Job;
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

/// The posterior, and what the summary says of metamodel and evaluations.
fn finished(service: &Service, id: i64) -> (String, [Value; 2]) {
    service.wait_for(id, "finished");
    let summary = service.client.json(&format!("/v1/calibrations/{id}/summary"));
    let calibration = &summary["calibrations"][0];
    let told = ["metamodel", "evaluations"].map(|key| calibration[key].clone());
    (service.posterior_csv(id), told)
}

#[test]
fn subchains_give_the_same_bytes_on_any_worker_and_over_a_restart() {
    let alone = Service::start(&[]);
    let id = alone.submit(&job());
    let _worker = alone.worker("alone", 1);
    let (expected, told) = finished(&alone, id);
    let [metamodel, evaluations] = told.each_ref();
    let count = |key: &str| metamodel[key].as_u64().expect("a count");
    assert!(count("moved") > 50, "{metamodel}");
    assert!(count("moved") < count("subchains"), "none stayed: {metamodel}");
    // eight moves to a subchain, unless it starts where the quasi-static model has no answer
    assert!(
        count("moves") > 7 * count("subchains") && count("moves") <= 8 * count("subchains"),
        "{metamodel}"
    );
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
        service.kill();
        service.restart();
    }
    let (posterior, again) = finished(&service, id);
    same(&posterior, &expected);
    assert_eq!(again, told);
}

#[test]
fn the_quasi_static_model_needs_no_metamodel_and_is_told_so() {
    let folder = tempfile::tempdir().unwrap();
    let moves = "moves = [2, 4]\nmetamodel_moves = 8";
    let path = Job::small().in_job("moves = [2, 4]", moves).write(folder.path());
    let error = programs::run(programs::coordinator(["check".as_ref(), path.as_os_str()])).refusal();
    assert!(
        error.contains("metamodel_moves under [sampler]: the metamodel is made of quasi_static"),
        "{error}"
    );
}

#[test]
fn what_the_quasi_static_model_cannot_express_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let prior = "[priors]\nflow_fraction = { uniform = [0.1, 0.4] }";
    let path = job().in_job("[priors]", prior).write(folder.path());
    let error = programs::run(programs::coordinator(["check".as_ref(), path.as_os_str()])).refusal();
    assert!(
        error.contains("flow_fraction: quasi_static has no terrain that deforms"),
        "{error}"
    );
}
