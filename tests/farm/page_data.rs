//! The data that a page needs besides results: examples, experiments, studies without some runs, curves of effects.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::items;
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;
use serde_json::{Value, json};

/// Returns a posted document, which must be accepted.
#[track_caller]
fn created(service: &Service, path: &str, body: &Value) -> Value {
    let response = service.client.post(path, body);
    assert_eq!(response.status, 201, "{}", response.body);
    response.json()
}

#[test]
fn an_example_is_submitted_with_its_files_as_they_come() {
    let service = Service::start(&[]);
    let listed = service.client.json("/v1/examples");
    let names: Vec<&str> = items(&listed)
        .filter_map(|example| example["name"].as_str())
        .collect();
    assert_eq!(
        names,
        ["hidden-effect", "cmu-sand", "cmu-sand-discover", "which-model"]
    );
    for name in names {
        let example = service.client.json(&format!("/v1/examples/{name}"));
        let new = json!({"toml": example["experiment"]["text"], "files": example["files"]});
        let experiment = created(&service, "/v1/experiments", &new)["id"].clone();
        let stored = service.client.json(&format!("/v1/experiments/{experiment}"));
        assert_eq!((&stored["toml"], &stored["files"]), (&new["toml"], &new["files"]));
        let job = json!({"experiment": experiment, "toml": example["job"]["text"], "name": name});
        created(&service, "/v1/calibrations", &job);
    }
    let experiments = service.client.json("/v1/experiments");
    assert_eq!(experiments[2], json!({"id": 3, "studies": [3]}));
    assert_eq!(service.client.get("/v1/examples/nothing").status, 404);
    assert_eq!(service.client.get("/v1/experiments/9").status, 404);
}

#[test]
fn what_a_study_says_without_some_runs_is_what_the_edited_file_says() {
    let service = Service::start(&["--local-workers", "2"]);
    let job = Job::small();
    let first = service.submit(&job);
    let path = format!("/v1/calibrations/{first}/what-if");
    let names: Vec<String> = job
        .runs
        .lines()
        .filter(|line| line.ends_with(",fit"))
        .filter_map(|line| Some(line.split(',').next()?.to_owned()))
        .collect();
    let without = &names[2..4];
    let what_if = created(&service, &path, &json!({ "without": without }));
    let [id, study] = ["id", "study"].map(|key| what_if[key].as_i64().expect("an id"));
    let edit = |line: &str| {
        let is_out = without.iter().any(|name| line.starts_with(&format!("{name},")));
        if is_out {
            line.replace(",fit", ",holdout")
        } else {
            line.to_owned()
        }
    };
    let runs: Vec<String> = job.runs.lines().map(edit).collect();
    let by_hand = Job {
        runs: runs.join("\n") + "\n",
        ..Job::small()
    };
    let by_hand = service.submit(&by_hand.in_job("[sampler]", "[discovery]\napply = \"ask\"\n[sampler]"));
    for id in [first, id, by_hand] {
        service.wait_for(id, "finished");
    }
    let posterior = |id: i64| service.part(id, "posterior").body;
    same(&posterior(id), &posterior(by_hand));
    assert!(posterior(id) != posterior(first));
    let search = until("the search of the new study", || {
        let members = service.client.json(&format!("/v1/studies/{study}"))["members"].clone();
        members
            .as_array()?
            .iter()
            .find(|m| m["kind"] == "search")
            .cloned()
    });
    assert_eq!(search["searches"].as_i64(), Some(id));
    let status = service.status(id);
    let expected = format!("calibration without {}, {}", without[0], without[1]);
    assert_eq!(status["name"].as_str(), Some(expected.as_str()));
    for (without, words) in [
        (json!(["nowhere"]), "there is no run \\\"nowhere\\\"".to_owned()),
        (
            json!(names),
            format!("all {} fitted runs are left out", names.len()),
        ),
    ] {
        let refused = service.client.post(&path, &json!({ "without": without }));
        assert_eq!(refused.status, 422, "{}", refused.body);
        assert_contains!(refused.body, words);
    }
}

#[test]
fn a_search_says_what_every_effect_predicts_and_the_summary_leaves_it_out() {
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.calibrate(&Job::hidden_shear());
    let found = until("the search", || {
        let response = service
            .client
            .try_get(&format!("/v1/calibrations/{id}/discovery"))
            .ok()?;
        (response.status == 200).then(|| response.json())
    });
    let curves = &found["curves"];
    let count = curves["data"].as_array().map(Vec::len);
    assert!(count > Some(0));
    let judged: Vec<&str> = items(&found["effects"])
        .filter_map(|effect| effect["name"].as_str())
        .filter(|name| *name != "none")
        .collect();
    for name in judged {
        let values = curves["effects"][name].as_array();
        assert_eq!(values.map(Vec::len), count, "{name}");
        let moved = values.is_some_and(|values| *values != *curves["base"].as_array().expect("values"));
        assert!(
            moved || name != found["effects"][0]["name"],
            "{name} changes nothing"
        );
    }
    let summary = until("a summary", || {
        let response = service
            .client
            .try_get(&format!("/v1/calibrations/{id}/summary"))
            .ok()?;
        (response.status == 200).then(|| response.json())
    });
    assert!(summary["discovery"]["rounds"][0]["effects"].is_array());
    assert_eq!(summary["discovery"]["rounds"][0].get("curves"), None);
}
