//! Questions about implausible values, and the options that accept the values.

use std::collections::BTreeMap;
use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::workspace;
use job::{Spec, questions};
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::text_file::{read_beside, read_text, sibling};

use super::bad_input::gallery::scaled;

#[test]
fn what_is_accepted_is_calibrated_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let few = Job {
        runs: Job::small()
            .runs
            .lines()
            .take(4)
            .map(|line| format!("{line}\n"))
            .collect(),
        ..Job::small()
    };
    let path = few.write(folder.path()).display().to_string();
    let out = folder.path().join("out").display().to_string();
    let message = run(coordinator(["run", &path, "--out", &out])).refusal();
    assert_contains!(message, "--accept data_few");
    run(coordinator(["run", &path, "--out", &out, "--accept", "data_few"])).success();
    let report = std::fs::read_to_string(Path::new(&out).join("report.html")).unwrap();
    assert!(report.contains("accepted as meant: data_few"));
    // The stored calibration is the same with the answer in the job and on the command line.
    run(coordinator(["run", &path, "--out", &out, "--accept", "data_few"])).success();
    let job = format!("accept = [\"data_few\"]\n{}", few.job);
    std::fs::write(&path, job).unwrap();
    run(coordinator(["run", &path, "--out", &out])).success();
}

#[test]
fn a_pull_of_the_wrong_sign_is_asked_about_by_the_service_and_accepted_on_demand() {
    let folder = tempfile::tempdir().unwrap();
    let runs = scaled(&Job::small().runs, "drawbar_pull_n", -1.0);
    let turned = Job { runs, ..Job::small() };
    let service = Service::start(&[]);
    let experiment = service.client.post("/v1/experiments", &turned.experiment_json());
    let id = experiment.json()["id"].clone();
    let submit = |job: &str| {
        let body = serde_json::json!({"experiment": id, "toml": job});
        service.client.post("/v1/calibrations", &body)
    };
    let refused = submit(&turned.job);
    assert_eq!(refused.status, 422);
    assert_contains!(
        refused.body,
        "drawbar_pull_n has the opposite sign",
        "run r06",
        "--accept drawbar_pull_sign"
    );
    let accepted = format!("accept = [\"drawbar_pull_sign\"]\n{}", turned.job);
    assert_eq!(submit(&accepted).status, 201);
    let path = turned.write(folder.path()).display().to_string();
    run(coordinator(["check", &path, "--accept", "drawbar_pull_sign"])).success();
}

#[test]
fn every_algorithm_that_the_schema_offers_can_be_submitted() {
    let schema = run(coordinator(["schema", "job"])).success();
    let schema: serde_json::Value = serde_json::from_str(&schema).unwrap();
    let sampler = &schema["properties"]["sampler"]["properties"];
    let service = Service::start(&[]);
    let experiment = service
        .client
        .post("/v1/experiments", &Job::small().experiment_json());
    let id = experiment.json()["id"].clone();
    let submit = |sampler: &str| {
        let settings = "algorithm = \"tmcmc\"\nparticles = 60\nmoves = [2, 4]";
        let body = serde_json::json!({"experiment": id, "toml": Job::small().in_job(settings, sampler).job});
        service.client.post("/v1/calibrations", &body)
    };
    let algorithms = sampler["algorithm"]["enum"].as_array().unwrap();
    for algorithm in algorithms {
        let submitted = submit(&format!("algorithm = {algorithm}"));
        assert_eq!(submitted.status, 201, "{algorithm}: {}", submitted.body);
    }
    let names = sampler["point_estimates"]["items"]["enum"].to_string();
    let submitted = submit(&format!("point_estimates = {names}"));
    assert_eq!(submitted.status, 201, "{names}: {}", submitted.body);
    // The search is not among the algorithms, and no message offers it.
    let refused = submit("algorithm = \"discoveri\"");
    assert_eq!(refused.status, 422);
    assert!(!refused.body.contains("discovery"), "{}", refused.body);
}

#[test]
fn a_name_that_is_no_question_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = Job::small().write(folder.path()).display().to_string();
    let refusal = run(coordinator(["check", &path, "--accept", "radus_m"])).refusal();
    assert!(
        refusal.ends_with("unknown name under accept \"radus_m\"; the nearest known is \"radius_m\""),
        "{refusal}"
    );
}

#[test]
fn the_examples_raise_no_question() {
    let mut raised = BTreeMap::new();
    for job in [
        "hidden-effect/job.toml",
        "paper/sharp.toml",
        "paper/table1.toml",
        "paper/bevameter.toml",
        "paper/bevameter-discover.toml",
        "cmu-sand/cmu-sand-scm.toml",
        "cmu-sand/plates.toml",
        "cmu-sand/job.toml",
        "cmu-sand/discover.toml",
        "cmu-sand/angles.toml",
        "cmu-sand/from-plates.toml",
        "cmu-sand/points-scm.toml",
        "cmu-sand/points-rolled.toml",
        "cmu-sand/all-runs.toml",
        "cmu-sand/histories.toml",
        "paper/transient.toml",
        "other-rigs/ding-2011/job.toml",
        "other-rigs/kls-1/job.toml",
        "other-rigs/kls-1/by-hand.toml",
        "other-rigs/rashid-1/job.toml",
    ] {
        let path = workspace::root().join("examples").join(job);
        let toml = read_text(&path).unwrap();
        let parsed = job::Job::parse(job, &toml).unwrap();
        let experiment =
            Experiment::read_files(&sibling(&path, &parsed.experiment.clone().unwrap())).unwrap();
        let files = read_beside(&path, &parsed.named_files()).unwrap();
        let spec = Spec::new(job, &FileSet { toml, files }, "experiment.toml", &experiment).unwrap();
        let open = questions(&spec)
            .into_iter()
            .filter(|q| !spec.accepted.contains(&q.name));
        raised.extend(open.map(|question| (job, question.words)));
    }
    assert_eq!(raised, BTreeMap::new());
}
