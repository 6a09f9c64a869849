//! Evolutionary searches and BASIS through real processes: they find the optimum, keep the contract, and give the same bytes after any
//! kill of a program.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::float;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;
use serde_json::Value;

use super::bad_input::{refusal, refused};

const SMALL: &str = "algorithm = \"tmcmc\"\nparticles = 60\nmoves = [2, 4]";
const GA: &str = "algorithm = \"ga\"\npopulation = 40\ngenerations = 200";
const CMA_ES: &str = "algorithm = \"cma-es\"\nmax_evaluations = 1200";

/// Returns the small job with another algorithm.
pub(super) fn job(sampler: &str) -> Job {
    Job::small().in_job(SMALL, sampler)
}

/// Returns a job for `ga` and one for `cma-es`.
pub(super) fn searches() -> [Job; 2] {
    [GA, CMA_ES].map(job)
}

/// Returns the summary of a finished calibration without its wall time.
fn summary(service: &Service, id: i64) -> Value {
    let mut summary = service.result(id, "summary");
    summary["point_estimates"][0]["wall_s"] = Value::Null;
    summary
}

#[test]
fn searches_find_what_the_fit_finds_and_keep_how_they_came_there() {
    let service = Service::start(&["--local-workers", "2"]);
    let finished = |job: &Job| {
        let id = service.calibrate(job);
        summary(&service, id)["point_estimates"][0].clone()
    };
    let fit = finished(&job("algorithm = \"lm\""));
    for (search, name) in searches().iter().zip(["ga", "cma-es"]) {
        let found = finished(search);
        assert_eq!(found["algorithm"], name);
        assert_eq!(found["sd"], Value::Null, "{found}");
        assert!(found["stop"] == "stagnation", "{name}: {}", found["stop"]);
        let best = |estimate: &Value| float(&estimate["log_posterior"]);
        assert!((best(&found) - best(&fit)).abs() < 0.1, "{name}: {found} {fit}");
        let history = found["history"].as_array().expect("a history");
        let last = history.last().expect("a generation");
        assert_eq!(last["best"], found["log_posterior"]);
        assert_eq!(last["evaluations"], found["evaluations"]);
        let bests: Vec<f64> = history.iter().filter_map(|g| g["best"].as_f64()).collect();
        assert!(bests.len() > 10 && bests.is_sorted(), "{bests:?}");
    }
}

#[test]
fn killing_coordinator_and_worker_amid_a_search_changes_no_byte() {
    for job in searches() {
        let expected = {
            let service = Service::start(&["--local-workers", "2"]);
            let id = service.calibrate(&job);
            summary(&service, id)
        };
        let mut service = Service::start(&[]);
        let id = service.submit(&job);
        let mut worker = service.worker("worker", 1);
        until("progress", || service.evaluations(id).filter(|&n| n >= 60));
        service.kill();
        worker.kill();
        service.restart();
        let _worker = service.worker("worker", 2);
        service.wait_for(id, "finished");
        same(&format!("{:#}", summary(&service, id)), &format!("{expected:#}"));
        assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
    }
}

#[test]
fn a_run_of_a_search_says_how_it_ended_and_check_what_it_costs() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job(CMA_ES)
        .write(&folder.path().join("job"))
        .display()
        .to_string();
    let out = folder.path().join("out").display().to_string();
    let printed = run(coordinator(["run", &path, "--out", &out])).success();
    assert_contains!(printed, "cma-es stopped by stagnation");
    let check = run(coordinator(["check", &path])).success();
    assert_contains!(
        check,
        "cma-es with at most 1200 evaluations",
        "The search itself took"
    );
}

#[test]
fn basis_samples_and_is_flagged() {
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.calibrate(&job("algorithm = \"basis\"\nparticles = 60"));
    let summary = service.result(id, "summary");
    let calibration = &summary["calibrations"][0];
    assert_eq!(calibration["algorithm"], "basis");
    assert_eq!(calibration["equilibrated"], false);
    assert!(
        calibration["stages"]
            .as_array()
            .is_some_and(|stages| stages.iter().all(|s| s["steps"] == 1))
    );
}

#[test]
fn keys_of_other_algorithms_are_refused_by_name() {
    let refusals = [
        (
            "basis",
            "moves = [2, 4]",
            "moves belongs to algorithm tmcmc and ching-chen-2007; basis takes particles, seed",
        ),
        (
            "ga",
            "max_evaluations = 9",
            "max_evaluations belongs to algorithm lm and cma-es; ga takes population, generations, seed",
        ),
        (
            "cma-es",
            "particles = 9",
            "particles belongs to algorithm tmcmc and ching-chen-2007 and basis and lm; cma-es takes population, max_evaluations, restarts, seed",
        ),
    ];
    for (algorithm, key, message) in refusals {
        let given = refusal(&job(&format!("algorithm = \"{algorithm}\"\n{key}")));
        assert_contains!(given, message);
    }
    for (sampler, message) in [
        (
            "algorithm = \"ga\"\npopulation = 4",
            "population = 4 is not from 8 to 100000",
        ),
        (
            "algorithm = \"ga\"\ngenerations = 1",
            "generations = 1 is not from 2 to 100000",
        ),
        (
            "algorithm = \"cma-es\"\nmax_evaluations = 15",
            "max_evaluations = 15 is not from 16 (two generations) to 1000000",
        ),
        (
            "algorithm = \"cma-es\"\nrestarts = 21",
            "restarts = 21 is above 20",
        ),
    ] {
        refused(job(sampler), &format!("job.toml: [sampler] {message}"));
    }
}
