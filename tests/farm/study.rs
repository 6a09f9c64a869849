//! A study of a sample and point estimates, each of which equals the result of its job alone.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{item_count, items};
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;
use farm_tests::workspace::{root, text};
use serde_json::{Value, json};

const SAMPLER: &str = "algorithm = \"tmcmc\"\nparticles = 60\nmoves = [2, 4]";

/// Returns the small job with two point estimates beside it.
fn job() -> Job {
    Job::small().in_job(
        SAMPLER,
        &format!("{SAMPLER}\npoint_estimates = [\"lm\", \"cma-es\"]"),
    )
}

/// Returns a summary without its wall times and the numbers of the store.
fn timeless(mut summary: Value) -> Value {
    for part in ["calibrations", "point_estimates"] {
        for calibration in summary[part].as_array_mut().expect("a list") {
            calibration["wall_s"] = Value::Null;
            calibration["calibration"] = Value::Null;
            calibration["experiment"] = Value::Null;
        }
    }
    summary
}

fn summary(service: &Service, id: i64) -> Value {
    timeless(service.result(id, "summary"))
}

/// Submits the job; returns the ids of the sample and of the point estimates.
fn submit(service: &Service) -> Vec<i64> {
    let first = service.submit(&job());
    let studies = service.client.json("/v1/studies");
    let ids: Vec<i64> = serde_json::from_value(studies[0]["calibrations"].clone()).expect("ids");
    assert_eq!(ids[0], first);
    ids
}

#[test]
fn each_calibration_of_a_study_is_what_the_same_job_gives_alone() {
    let service = Service::start(&["--local-workers", "2"]);
    let ids = submit(&service);
    assert_eq!(ids.len(), 3);
    for &id in &ids {
        service.wait_for(id, "finished");
    }
    let study = summary(&service, ids[0]);
    assert_eq!(study["status"], "finished");
    // The summary of every calibration is that of its study.
    assert_eq!(summary(&service, ids[2]), study);
    let mut alone = Vec::new();
    for sampler in [
        SAMPLER,
        "algorithm = \"lm\"\nparticles = 0",
        "algorithm = \"cma-es\"",
    ] {
        let id = service.calibrate(&Job::small().in_job(SAMPLER, sampler));
        alone.push(summary(&service, id));
    }
    assert_eq!(study["calibrations"], alone[0]["calibrations"]);
    let estimates = json!([alone[1]["point_estimates"][0], alone[2]["point_estimates"][0]]);
    same(
        &format!("{:#}", study["point_estimates"]),
        &format!("{estimates:#}"),
    );
    let figures = service
        .client
        .json(&format!("/v1/calibrations/{}/figures", ids[0]));
    assert_eq!(figures["searches"][0]["algorithm"], "cma-es");
    let labels: Vec<&str> = items(&figures["errors"][0]["marks"])
        .filter_map(|mark| mark["label"].as_str())
        .collect();
    assert_eq!(
        labels,
        ["mean", "maximum likelihood", "LM optimum", "CMA-ES optimum"],
        "{:#}",
        figures["errors"][0]["marks"]
    );
    let ledger = service.client.json("/v1/studies/1");
    assert_eq!(item_count(&ledger["ledger"]), 1);
    assert_eq!(item_count(&ledger["point_estimates"]), 2);
}

#[test]
fn killing_coordinator_and_worker_amid_a_study_changes_no_byte() {
    let expected = {
        let service = Service::start(&["--local-workers", "2"]);
        let ids = submit(&service);
        for &id in &ids {
            service.wait_for(id, "finished");
        }
        summary(&service, ids[0])
    };
    let mut service = Service::start(&[]);
    let ids = submit(&service);
    let mut worker = service.worker("worker", 1);
    until("progress", || service.evaluations(ids[0]).filter(|&n| n >= 60));
    service.kill();
    worker.kill();
    service.restart();
    let _worker = service.worker("worker", 2);
    for &id in &ids {
        service.wait_for(id, "finished");
    }
    same(
        &format!("{:#}", summary(&service, ids[0])),
        &format!("{expected:#}"),
    );
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
}

#[test]
fn a_run_prints_the_whole_study_and_knows_its_folder_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job().write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out");
    let go = || coordinator(["run", &path, "--out", &out.display().to_string()]);
    let printed = run(go()).success();
    assert_contains!(
        printed,
        "root mean sq. error",
        "lm stopped by",
        "cma-es stopped by",
        "\nwrong:",
        "\nmissing:",
        "\nnext:"
    );
    let summary: Value = serde_json::from_str(&text(&out.join("summary.json"))).expect("JSON");
    let counts = ["calibrations", "point_estimates"].map(|part| summary[part].as_array().map(Vec::len));
    assert_eq!(counts, [Some(1), Some(2)]);
    assert_eq!(run(go()).success(), printed, "a finished study is printed again");
    // The command needs no id in a folder with one study.
    let report = run(coordinator(["report", "--out", &out.display().to_string()])).success();
    assert!(report.contains("\"kind\":\"fit\""));
    let other = job().in_job(", \"cma-es\"", "");
    other.write(&folder.path().join("job"));
    let refusal = run(go()).refusal();
    assert_contains!(refusal, "the job or its experiment has changed");
}

#[test]
fn check_says_what_the_point_estimates_may_cost() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job().write(&folder.path().join("job")).display().to_string();
    let check = run(coordinator(["check", &path])).success();
    assert_contains!(
        check,
        "point estimate lm with at most 200 evaluations",
        "point estimate cma-es with"
    );
}

#[test]
fn the_papers_jobs_are_studies_of_a_sample_and_searches() {
    let service = Service::start(&[]);
    for job in ["table1", "sharp", "bevameter"] {
        let path = root()
            .join(format!("examples/paper/{job}.toml"))
            .display()
            .to_string();
        let output = run(coordinator(["submit", &path, "--url", &service.url()])).success();
        assert_contains!(output, "beside it");
    }
    let studies = service.client.json("/v1/studies");
    let sizes: Vec<usize> = items(&studies)
        .map(|study| study["calibrations"].as_array().map_or(0, Vec::len))
        .collect();
    assert_eq!(sizes, [2, 3, 2], "sharp.toml asks for cma-es as well");
    let list = service.client.json("/v1/calibrations");
    assert_eq!(list[1]["name"], "table1 (ga)");
}
