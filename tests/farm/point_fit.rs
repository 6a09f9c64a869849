//! A fit of the most probable parameters through real processes: it needs few evaluations, finds the truth, and gives the same bytes after
//! any kill of a program.

use farm_tests::assert_contains;
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::json::{float, item_count, whole};
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;
use serde_json::Value;

use super::bad_input::{refusal, refused};

/// Returns the small job as a fit without draws.
pub(super) fn fit() -> Job {
    Job::small().in_job(
        "algorithm = \"tmcmc\"\nparticles = 60\nmoves = [2, 4]",
        "algorithm = \"lm\"\nparticles = 0",
    )
}

/// The truth behind `nothing-hidden`: `tests/data/nothing-hidden/parameters.toml`.
const TRUTH: [(&str, f64); 4] = [
    ("log10_p_ref", 4.559),
    ("n", 1.118),
    ("friction_angle_deg", 27.87),
    ("wheel_radius_m", 0.1285),
];

/// Returns everything that a finished fit says but its wall time.
fn result(service: &Service, id: i64) -> String {
    let mut summary = service.result(id, "summary");
    summary["point_estimates"][0]["wall_s"] = Value::Null;
    let comparison = service.result(id, "comparison");
    format!("{summary:#}\n{comparison:#}\n{}", service.posterior_csv(id))
}

#[test]
fn a_fit_finds_the_truth_with_few_evaluations() {
    let service = Service::start(&[]);
    let id = service.submit(&fit());
    let _worker = service.worker("worker", 2);
    service.wait_for(id, "finished");
    let summary = service.result(id, "summary");
    let estimate = &summary["point_estimates"][0];
    let evaluations = whole(&estimate["evaluations"]);
    assert!(evaluations <= 200, "{estimate}");
    // Two further evaluations simulate the fitted and the held-out runs at the optimum.
    assert_eq!(
        service.metric("grouser_evaluations_completed_total"),
        evaluations + 2
    );
    for (name, truth) in TRUTH {
        let value = float(&estimate["parameters"][name]);
        let sd = float(&estimate["sd"][name]);
        assert!(
            (value - truth).abs() < 4.0 * sd,
            "{name} = {value} +- {sd}, not {truth}"
        );
    }
    for part in ["fit", "holdout"] {
        let sigma = estimate["error"][part]["all"]["rmse_sigma"].as_f64();
        assert!(
            sigma.is_some_and(|s| (0.7..1.4).contains(&s)),
            "{part}: {sigma:?}"
        );
    }
    let page = run(coordinator(["report", "1", "--url", &service.url()])).success();
    assert_contains!(page, "lm with at most 200 evaluations");
    let ledger = service.client.json("/v1/studies/1");
    assert_eq!(item_count(&ledger["ledger"]), 0);
    assert_eq!(ledger["point_estimates"][0], *estimate);
}

#[test]
fn killing_coordinator_and_worker_amid_a_fit_changes_no_byte() {
    // Every run occurs forty times, so that an evaluation takes long enough to be interrupted.
    let job = fit();
    let (head, rows): (Vec<&str>, Vec<&str>) = job
        .runs
        .lines()
        .partition(|line| line.starts_with('#') || line.starts_with("run,"));
    let copies = (0..40).flat_map(|k| rows.iter().map(move |row| format!("c{k}-{row}")));
    let runs: Vec<String> = head.iter().map(|&line| line.to_owned()).chain(copies).collect();
    let job = Job {
        runs: runs.join("\n") + "\n",
        ..job
    };
    let expected = {
        let service = Service::start(&["--local-workers", "2"]);
        let id = service.calibrate(&job);
        result(&service, id)
    };
    let mut service = Service::start(&[]);
    let id = service.submit(&job);
    let mut worker = service.worker("worker", 1);
    let mut seen = 0;
    for least in [3, 8, 14, 22] {
        seen = until("progress", || {
            service.evaluations(id).filter(|&n| n >= least.max(seen + 1))
        });
        service.kill();
        worker.kill();
        service.restart();
        worker = service.worker("worker", 1);
    }
    service.wait_for(id, "finished");
    same(&result(&service, id), &expected);
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
    assert!(worker.is_running());
}

#[test]
fn a_run_of_a_fit_prints_it_again_and_check_says_what_it_costs() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = fit().write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out").display().to_string();
    let command = || run(coordinator(["run", &path, "--out", &out, "--verbose"])).success();
    let first = command();
    assert_contains!(
        first,
        "lm stopped by",
        "log-posterior",
        "best",
        "root mean square error",
        "holdout"
    );
    assert!(!first.contains("90 % intervals contain"), "{first}");
    same(&command(), &first);
    // A point estimate has no draws.
    let csv = std::fs::read_to_string(folder.path().join("out/posterior.csv")).expect("posterior.csv");
    assert_eq!(
        csv,
        "log_likelihood,log_prior,log10_p_ref,n,friction_angle_deg,wheel_radius_m\n"
    );
    let check = run(coordinator(["check", &path])).success();
    let line = format!("(one evaluation: {FIT_RUNS} runs)");
    assert_contains!(check, "lm with at most 200 evaluations", &line);
}

#[test]
fn keys_of_another_algorithm_are_refused_by_name() {
    let small = Job::small;
    let accepted = "lm takes particles, starts, max_evaluations, difference_step, seed";
    let message = refusal(&small().in_job("\"tmcmc\"", "\"lm\""));
    assert_contains!(
        message,
        "[sampler] moves belongs to algorithm tmcmc and ching-chen-2007",
        accepted
    );
    for key in ["starts = 3", "max_evaluations = 100", "difference_step = 0.01"] {
        let message = refusal(&small().in_job("seed = 1", &format!("seed = 1\n{key}")));
        let name = key.split(' ').next().unwrap_or_default();
        assert_contains!(
            message,
            &format!("[sampler] {name} belongs to algorithm lm"),
            "; tmcmc takes"
        );
    }
    refused(
        fit().in_job("seed = 1", "max_evaluation = 50"),
        "job.toml line 17: unknown key \"max_evaluation\"; the nearest known is \"max_evaluations\"",
    );
    refused(
        fit().in_job("seed = 1", "max_evaluations = 9"),
        "job.toml: [sampler] max_evaluations = 9 is below 10: 5 starts, 4 differences and one step",
    );
    refused(
        fit().in_job("seed = 1", "difference_step = 0.7"),
        "job.toml: [sampler] difference_step = 0.7 prior widths is not above 0 and at most 0.5",
    );
    refused(
        fit().in_job("seed = 1", "starts = 0"),
        "job.toml: [sampler] starts = 0 is below 1",
    );
}
