//! The growth of a study by effects and by further runs, refused extensions, and restarts meanwhile.

use farm_tests::assert_contains;
use farm_tests::job::{GAIN, Job};
use farm_tests::json::{item_count, items};
use farm_tests::programs::{coordinator, run};
use farm_tests::random::Random;
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;
use farm_tests::workspace::text;
use serde_json::{Value, json};

/// Two further runs, without one column of the experiment.
const MORE: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,use
later-1,WHEEL,SOIL,0.25,100,0.01,30.0,6.0,fit
later-2,WHEEL,SOIL,0.35,100,0.01,33.0,6.4,holdout
";

/// [`MORE`] for the wheel and the soil of the small job.
fn more() -> String {
    let small = Job::small();
    let mut lines = small.runs.lines().filter(|line| !line.starts_with('#'));
    let first: Vec<&str> = lines.nth(1).expect("a run").split(',').collect();
    MORE.replace("WHEEL", first[1]).replace("SOIL", first[2])
}

fn summary(service: &Service, id: i64) -> Value {
    let mut summary = service.result(id, "summary");
    for calibration in summary["calibrations"].as_array_mut().expect("a list") {
        calibration["wall_s"] = Value::Null;
    }
    summary
}

#[track_caller]
fn created(service: &Service, path: &str, body: &Value) -> i64 {
    let response = service.client.post(path, body);
    assert_eq!(response.status, 201, "{}", response.body);
    response.json()["id"].as_i64().expect("an id")
}

/// Returns the effects of each line of the ledger.
fn ledger(summary: &Value) -> Vec<String> {
    let calibrations = items(&summary["calibrations"]);
    calibrations.map(|c| c["effects"].to_string()).collect()
}

#[test]
fn a_study_grows_by_effects_and_by_runs() {
    let service = Service::start(&["--local-workers", "2"]);
    let job = Job::small().in_job("seed = 1", "seed = 1\npoint_estimates = [\"lm\"]");
    let base = service.submit(&job);
    let path = |id: i64| format!("/v1/calibrations/{id}/extend");
    let named = created(&service, &path(base), &json!({"effect": "torque_gain"}));
    let file = json!({"effect_file": {"name": "gain.toml", "text": GAIN}});
    let both = created(&service, &path(named), &file);
    let enlarged = created(&service, "/v1/studies/1/runs", &json!({"runs": more()}));
    for id in [base, base + 1, named, both, enlarged] {
        service.wait_for(id, "finished");
    }
    let summary = summary(&service, enlarged);
    assert_eq!(summary["status"], "finished");
    let two = "[\"torque_gain\",\"my_gain\"]";
    assert_eq!(ledger(&summary), ["[]", "[\"torque_gain\"]", two, two]);
    let runs = |i: usize| {
        let table = &summary["calibrations"][i]["error"];
        (
            table["fit"]["torque"]["runs"].as_u64(),
            table["holdout"]["torque"]["runs"].as_u64(),
            table["fit"]["sinkage"]["runs"].as_u64(),
        )
    };
    assert_eq!(runs(2), (Some(24), Some(16), Some(24)));
    assert_eq!(runs(3), (Some(25), Some(17), Some(24)), "their sinkage is blank");
    let lines = summary["calibrations"].as_array().expect("a ledger");
    let data: Vec<String> = lines
        .iter()
        .map(|line| {
            format!(
                "{}: {} + {}",
                line["data_set"], line["fitted_runs"], line["held_out_runs"]
            )
        })
        .collect();
    assert_eq!(data, ["1: 24 + 16", "1: 24 + 16", "1: 24 + 16", "2: 25 + 17"]);
    assert_eq!(item_count(&summary["point_estimates"]), 1, "the submitted job's");
    assert_eq!(summary["discovery"], Value::Null, "nobody has searched");
    let experiments: Vec<Value> = [base, both, enlarged]
        .map(|id| service.status(id)["experiment"].clone())
        .to_vec();
    assert!(experiments[0] == experiments[1] && experiments[0] != experiments[2]);
    let ledger = service.client.json("/v1/studies/1");
    assert_eq!(item_count(&ledger["ledger"]), 4);
}

#[test]
fn a_parameter_that_the_job_holds_is_freed_as_an_effect_is_added() {
    let service = Service::start(&["--local-workers", "2"]);
    let base = service.submit(&Job::small());
    let path = format!("/v1/calibrations/{base}/extend");
    // The job fixes the velocity under [model], and leaves the cohesion at its default.
    let freed = created(&service, &path, &json!({"effect": "shear_velocity_m_s"}));
    let path = format!("/v1/calibrations/{freed}/extend");
    let both = created(&service, &path, &json!({"effect": "cohesion_pa"}));
    for id in [base, freed, both] {
        service.wait_for(id, "finished");
    }
    let summary = summary(&service, both);
    let two = "[\"cohesion_pa\",\"shear_velocity_m_s\"]";
    assert_eq!(ledger(&summary), ["[]", "[\"shear_velocity_m_s\"]", two]);
    let cohesion = &summary["calibrations"][2]["parameters"]["cohesion_pa"];
    assert!(cohesion["sd"].as_f64() > Some(0.0), "{cohesion}");
    let path = format!("/v1/calibrations/{both}/extend");
    let again = service.client.post(&path, &json!({"effect": "cohesion_pa"}));
    assert!(again.status == 422, "{}", again.body);
    assert!(again.body.contains("already under [priors]"), "{}", again.body);
}

#[test]
fn an_extension_is_the_calibration_of_the_same_job_submitted_alone() {
    let service = Service::start(&["--local-workers", "2"]);
    let base = service.submit(&Job::small());
    let path = format!("/v1/calibrations/{base}/extend");
    let extended = created(&service, &path, &json!({"effect": "torque_gain"}));
    let job = Job::small().in_job(
        "shear_velocity_m_s = 0.001",
        "shear_velocity_m_s = 0.001\neffects = [\"torque_gain\"]",
    );
    let alone = service.submit(&job);
    for id in [base, extended, alone] {
        service.wait_for(id, "finished");
    }
    same(&service.posterior_csv(extended), &service.posterior_csv(alone));
}

#[test]
fn killed_behind_the_answer_an_extension_goes_on_to_the_same_bits() {
    let expected = {
        let service = Service::start(&["--local-workers", "2"]);
        let base = service.submit(&Job::small());
        let path = format!("/v1/calibrations/{base}/extend");
        let extended = created(&service, &path, &json!({"effect": "torque_gain"}));
        service.wait_for(extended, "finished");
        service.wait_for(base, "finished");
        summary(&service, base)
    };
    let mut service = Service::start(&[]);
    let base = service.submit(&Job::small());
    let path = format!("/v1/calibrations/{base}/extend");
    let extended = created(&service, &path, &json!({"effect": "torque_gain"}));
    service.crash();
    let mut worker = service.worker("worker", 1);
    service.wait_for(base, "finished");
    service.kill();
    worker.kill();
    service.restart();
    let _worker = service.worker("worker", 2);
    service.wait_for(extended, "finished");
    same(
        &format!("{:#}", summary(&service, base)),
        &format!("{expected:#}"),
    );
    let studies = service.client.json("/v1/studies");
    assert_eq!(
        studies[0]["calibrations"],
        json!([base, extended]),
        "and nothing else was added"
    );
}

#[test]
fn what_cannot_be_added_says_why() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let refused = |path: String, body: Value, status: u16, words: &str| {
        let response = service.client.post(&path, &body);
        let message = response.json()["error"]["message"].clone();
        assert_eq!(response.status, status, "{message}");
        assert!(
            message.as_str().is_some_and(|m| m.contains(words)),
            "{words} in {message}"
        );
    };
    let extend = |id: i64| format!("/v1/calibrations/{id}/extend");
    let effect = |name: &str| json!({ "effect": name });
    refused(
        extend(id),
        effect("bulldosing"),
        422,
        "unknown effect \"bulldosing\"; the nearest known is \"bulldozing\"",
    );
    refused(extend(9), effect("bulldozing"), 404, "there is no calibration 9");
    refused(extend(id), json!({}), 400, "an extension is");
    let both = json!({"effect": "bulldozing", "effect_file": {"name": "gain.toml", "text": GAIN}});
    refused(extend(id), both, 400, "an extension is");
    let broken = GAIN.replace("shift_n\"", "shift\"");
    let file = json!({"effect_file": {"name": "gain.toml", "text": broken}});
    refused(extend(id), file, 422, "gain.toml line");
    let extended = created(&service, &extend(id), &effect("torque_gain"));
    refused(
        extend(extended),
        effect("torque_gain"),
        422,
        "\"torque_gain\" appears twice",
    );

    let runs = "/v1/studies/1/runs".to_owned();
    let with = |old: &str, new: &str| json!({"runs": more().replace(old, new)});
    refused(
        runs.clone(),
        with("0.35,", "1.35,"),
        422,
        "runs.csv line 3: slip 1.35 must be at most 1",
    );
    refused(
        runs.clone(),
        with("later-2", "later-1"),
        422,
        "line 3: run \"later-1\" appears twice",
    );
    refused(
        runs.clone(),
        with("torque_n_m", "torque"),
        422,
        "unknown column \"torque\"",
    );
    refused(
        "/v1/studies/9/runs".into(),
        with("", ""),
        404,
        "there is no study 9",
    );
    created(&service, &runs, &json!({"runs": more()}));
    refused(
        runs,
        json!({"runs": more()}),
        422,
        "runs.csv line 2: run \"later-1\" is in the study already",
    );

    let discovery = service.part(id, "discovery");
    assert_eq!(discovery.status, 404, "{}", discovery.body);
    assert!(
        discovery
            .body
            .contains("no search for a missing effect of calibration 1"),
        "{}",
        discovery.body
    );
    let list = service.client.json("/v1/calibrations");
    assert_eq!(item_count(&list), 3, "what was refused left nothing behind");
}

#[test]
fn a_folder_grows_and_its_run_knows_it_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = Job::small()
        .write(&folder.path().join("job"))
        .display()
        .to_string();
    let out = folder.path().join("out").display().to_string();
    let runs = folder.path().join("more.csv");
    std::fs::write(&runs, more()).expect("a file");
    let go = |words: &[&str]| run(coordinator(words.iter().copied().chain(["--out", &out])));
    go(&["run", &path]).success();
    let refusal = go(&["extend", "--effect", "bulldosing"]).refusal();
    assert_contains!(refusal, "the nearest known is \"bulldozing\"");
    let printed = go(&["extend", "--effect", "torque_gain", "--verbose"]).success();
    assert_contains!(printed, "model quasi_static with torque_gain");
    let again = go(&["extend", "1", "--effect", "torque_gain"]);
    assert_contains!(again.stderr, "calibration 2 has it already");
    let enlarged = go(&["add-runs", "2", &runs.display().to_string()]).success();
    assert_contains!(enlarged, "with torque_gain, 25 fitted runs");
    assert_eq!(
        go(&["run", &path]).success(),
        enlarged,
        "a grown study is printed again"
    );
    let file = text(&folder.path().join("out/summary.json"));
    let summary: Value = serde_json::from_str(&file).expect("JSON");
    assert_eq!(ledger(&summary), ["[]", "[\"torque_gain\"]", "[\"torque_gain\"]"]);
    let report = text(&folder.path().join("out/report.html"));
    assert_contains!(report, "\"/v1/calibrations/3/comparison\"", "\"ledger\":[");
}

/// Returns a study that finds an effect and extends its model automatically.
fn hidden() -> Job {
    Job::hidden_shear().sampler(120, [2, 6], 1)
}

/// Returns the calibrations of the service that are in progress: id, name, evaluations.
fn in_progress(service: &Service) -> Option<Vec<(i64, String, u64)>> {
    let response = service.client.try_get("/v1/calibrations").ok()?;
    let list = (response.status == 200).then(|| response.json())?;
    let open = list.as_array()?.iter().filter_map(|status| {
        let evaluations = status["progress"]["evaluations"].as_u64()?;
        let name = status["name"].as_str()?.to_owned();
        Some((status["id"].as_i64()?, name, evaluations))
    });
    Some(open.collect())
}

/// Returns the summary once the study takes no further step.
fn over(service: &Service) -> Value {
    until("the end of the study", || {
        let response = service.client.try_get("/v1/calibrations/1/summary").ok()?;
        let finished = response.status == 200 && response.json()["status"] == "finished";
        finished.then(|| summary(service, 1))
    })
}

#[test]
fn killing_coordinator_and_workers_while_a_study_is_searched_changes_nothing() {
    let quiet = Service::start(&["--local-workers", "2"]);
    quiet.submit(&hidden());
    let expected = over(&quiet);
    let chosen = &expected["discovery"]["chosen"];
    assert_eq!(chosen, &json!(["janosi_hanamoto"]), "{expected:#}");
    assert_eq!(item_count(&expected["calibrations"]), 2);
    let explanations = expected["discovery"]["effects"].as_array().expect("a list");
    let named = explanations
        .iter()
        .find(|effect| effect["name"] == "janosi_hanamoto");
    assert_eq!(
        named.map(|effect| &effect["units"]),
        Some(&json!({"janosi_hanamoto.shear_modulus_m": "m"}))
    );
    drop(quiet);
    let mut service = Service::start(&["--lease-ms", "500"]);
    service.submit(&hidden());
    let mut worker = service.worker("worker", 2);
    let mut random = Random::new(7);
    let mut kills = 0;
    for moment in [60, 250, 500, 800] {
        let reached = until("the search", || {
            let open = in_progress(&service)?;
            let search = open.iter().find(|(_, name, _)| name.ends_with("(discovery)"));
            // The moment falls into the first search, or the search is over and the extended model is calibrated.
            match search {
                Some((_, _, evaluations)) if *evaluations >= moment => Some(true),
                None if open.iter().any(|(_, name, _)| name.contains('+')) => Some(false),
                _ => None,
            }
        });
        kills += u32::from(reached);
        if random.below(2) == 0 {
            worker.kill();
            worker = service.worker("worker", 2);
        }
        service.crash();
    }
    assert!(kills >= 2, "{kills} kills fell within a search");
    let found = over(&service);
    same(
        &serde_json::to_string_pretty(&found).expect("JSON"),
        &serde_json::to_string_pretty(&expected).expect("JSON"),
    );
}
