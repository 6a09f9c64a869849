//! A job with several models: the model that made the data is named, also after kills, and no model is named if none explains the data.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::float;
use farm_tests::programs::{coordinator, run, study};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until_true;
use serde_json::Value;

const MODELS: [&str; 3] = ["quasi_static", "wong_reece", "rft"];

/// The example: data of `wong_reece`.
fn example() -> Job {
    Job::example("which-model")
}

fn compared(summary: &Value) -> &Vec<Value> {
    summary["models"]["models"].as_array().expect("a comparison")
}

#[test]
fn the_model_that_made_the_data_is_named_with_its_probability() {
    let (printed, summary) = study(&example());
    let models = compared(&summary);
    let kinds: Vec<&str> = models.iter().filter_map(|m| m["kind"].as_str()).collect();
    assert_eq!(kinds, MODELS);
    let probabilities: Vec<f64> = models.iter().filter_map(|m| m["probability"].as_f64()).collect();
    assert!(probabilities[1] > 0.99 && (probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    let comparison = &summary["models"];
    assert_eq!(comparison["best"], models[1]["calibration"]);
    assert_eq!(comparison["best_predicting"], models[1]["calibration"]);
    assert_eq!(comparison["none_of_these"], false, "{comparison}");
    assert_eq!(summary["model_kind"], "wong_reece");
    let ledger = summary["calibrations"].as_array().expect("a ledger");
    assert_eq!(ledger.len(), 1, "the other models are no lines of the ledger");
    assert_eq!(ledger[0]["calibration"], models[1]["calibration"]);
    for model in models {
        assert_eq!(model["left_out_by"], "holdout");
        assert!(model["left_out"]["drawbar_pull"]["rmse"].as_f64().is_some());
    }
    assert_contains!(printed, "model:   wong_reece is the most probable of 3 models");
    assert_contains!(printed, "P from equal prior odds; errors of held-out runs");
    // The true parameters are c1 = 0.4 and K = 10 mm.
    let parameters = &ledger[0]["parameters"];
    for (name, truth) in [("c1", 0.4), ("shear_modulus_m", 0.01)] {
        let value = |key: &str| float(&parameters[name][key]);
        assert!(
            (value("mean") - truth).abs() < 4.0 * value("sd"),
            "{name}: {parameters}"
        );
    }
}

/// Returns a smaller job, which is computed twice.
fn small() -> Job {
    example().in_job("particles = 500", "particles = 150\nmoves = [2, 4]")
}

fn posteriors(service: &Service, first: i64) -> Vec<String> {
    (first..first + 3).map(|id| service.posterior_csv(id)).collect()
}

#[test]
fn a_comparison_that_is_killed_ends_with_the_same_bits() {
    let undisturbed = {
        let service = Service::start(&["--local-workers", "2"]);
        let id = service.submit(&small());
        for id in id..id + 3 {
            service.wait_for(id, "finished");
        }
        posteriors(&service, id)
    };
    let mut service = Service::start(&["--lease-ms", "500"]);
    let id = service.submit(&small());
    let mut worker = service.worker("a", 1);
    for model in id..id + 3 {
        until_true("progress of a model", || {
            let status = service.status(model);
            let begun = status["progress"]["evaluations"]
                .as_u64()
                .is_some_and(|n| n > 200);
            begun || status["state"] == "finished"
        });
        service.kill();
        worker.kill();
        service.restart();
        worker = service.worker("a", 1);
    }
    for id in id..id + 3 {
        service.wait_for(id, "finished");
    }
    for (killed, undisturbed) in posteriors(&service, id).iter().zip(&undisturbed) {
        same(killed, undisturbed);
    }
}

#[test]
fn data_that_no_model_explains_are_none_of_these() {
    // No model predicts a pull that alternates from run to run.
    let job = small();
    let job = Job {
        job: format!("accept = [\"force_zero\"]\n{}", job.job),
        ..job
    };
    let mut lines = job.runs.lines().map(str::to_owned).collect::<Vec<_>>();
    let head = lines
        .iter()
        .position(|line| line.starts_with("run,"))
        .expect("a head");
    let column = lines[head]
        .split(',')
        .position(|name| name == "drawbar_pull_n")
        .expect("pull");
    for (k, line) in lines[head + 1..].iter_mut().enumerate() {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let pull: f64 = cells[column].parse().expect("a number");
        cells[column] = (pull + [8.0, -8.0][k % 2]).to_string();
        *line = cells.join(",");
    }
    let runs = lines.join("\n") + "\n";
    let (printed, summary) = study(&Job { runs, ..job });
    assert_eq!(summary["models"]["none_of_these"], true, "{}", summary["models"]);
    assert_contains!(printed, "none of these");
}

#[test]
fn check_costs_every_model_and_names_the_line_of_a_mistake() {
    let folder = tempfile::tempdir().expect("a folder");
    let check = |job: &Job, name: &str| {
        let path = job.write(&folder.path().join(name));
        run(coordinator([Path::new("check"), &path]))
    };
    let printed = check(&small(), "right").success();
    for kind in MODELS {
        assert_contains!(printed, format!("\n{kind}:"));
    }
    assert_contains!(printed, "model 3 of 3", "all models: ");
    let wrong = small().in_job(
        "kind = \"rft\"\n[models.priors]",
        "kind = \"rft\"\nn = 1.1\n[models.priors]",
    );
    let refusal = check(&wrong, "wrong").refusal();
    assert_contains!(refusal, "job.toml line 10: [[models]] rft: n is a parameter of");
}

#[test]
fn the_search_goes_on_with_the_most_probable_model() {
    // The job compares wong_reece with quasi_static only, and its search does not extend the model.
    let job = small()
        .in_job(
            "[[models]]\nkind = \"rft\"\n[models.priors]\nxi_n_pa_m = { loguniform = [1e5, 1e8] }\n",
            "",
        )
        .in_job("[sampler]", "[discovery]\napply = \"ask\"\n[sampler]");
    let (_, summary) = study(&job);
    let best = &compared(&summary)[1];
    assert_eq!(summary["models"]["best"], best["calibration"]);
    assert!(
        summary["discovery"]["verdict"].is_string(),
        "{}",
        summary["discovery"]
    );
}
