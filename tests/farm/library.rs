//! Laws that join the library: `coordinator library`, and the searches that try them.

use farm_tests::assert_contains;
use farm_tests::job::{GAIN, Job};
use farm_tests::json::{float, items, word};
use farm_tests::programs::{Ended, coordinator, run};
use farm_tests::service::Service;
use farm_tests::wait::until_true;
use serde_json::Value;

/// Runs whose shear stress follows a law of the sliding speed that the catalogue does not have, as a study that searches.
fn hidden_law() -> Job {
    Job::data("outside-the-catalogue").in_job(
        "seed = 1",
        "seed = 1\nalgorithm = \"lm\"\n[discovery]\napply = \"ask\"",
    )
}

/// The same runs with other errors of measurement, far below the noise.
fn measured_anew(job: Job) -> Job {
    let cell = |row: usize, column: usize, cell: &str| match column {
        8..=10 => {
            let measured: f64 = cell.parse().expect("a measured value");
            (measured * (1.0 + 0.004 * (row as f64).sin())).to_string()
        }
        _ => cell.to_owned(),
    };
    let line = |(row, line): (usize, &str)| match row {
        0 => format!("{line}\n"),
        _ => {
            let cells = line
                .split(',')
                .enumerate()
                .map(|(column, text)| cell(row, column, text));
            cells.collect::<Vec<_>>().join(",") + "\n"
        }
    };
    let runs = job.runs.lines().enumerate().map(line).collect();
    Job { runs, ..job }
}

/// Submits a job, waits for its search, and returns the calibration and the record of the search.
fn searched(service: &Service, job: &Job) -> (i64, Value) {
    let id = service.submit(job);
    service.wait_for(id, "finished");
    until_true("the search is finished", || {
        service.part(id, "discovery").status == 200
    });
    (id, service.result(id, "discovery"))
}

#[track_caller]
fn library(service: &Service, arguments: &[&str]) -> Ended {
    let url = service.url();
    let named = ["library"].iter().chain(arguments).copied();
    run(coordinator(named.chain(["--url", &url])))
}

/// The entry of an explanation in a record; `None` if the search did not have it.
fn explanation<'a>(record: &'a Value, name: &str) -> Option<&'a Value> {
    items(&record["effects"]).find(|effect| effect["name"] == name)
}

#[test]
fn a_law_that_one_study_found_is_tried_and_weighed_by_later_ones() {
    let service = Service::start(&["--local-workers", "2"]);
    assert_contains!(
        library(&service, &["list"]).success(),
        "no law has joined the library"
    );
    let (first, record) = searched(&service, &hidden_law());
    assert_eq!(record["verdict"], "not_in_library", "{}", record["text"]);
    let from = first.to_string();
    let refusal = library(&service, &["add", "--from", &from, "--law", "shear_j"]).refusal();
    assert_contains!(refusal, "has no such law: it found ");

    let added = library(&service, &["add", "--from", &from, "--as", "fast_shear"]).success();
    assert_contains!(
        added,
        "fast_shear (version 1) is tried by every search that begins from now on"
    );
    assert_contains!(added, "found by the search of calibration 1 of study 1");
    assert_contains!(added, "no study counts as evidence yet");

    // Another rig: the same law, measured anew. It is named, and it is said in words of its own.
    let other_rig = measured_anew(hidden_law());
    let (second, record) = searched(&service, &other_rig);
    assert_eq!(record["verdict"], "named", "{}", record["text"]);
    assert_contains!(word(&record["text"]), "fast_shear is missing: ");
    let judged = explanation(&record, "fast_shear").expect("the law is tried");
    assert!(float(&judged["probability"]) > 0.9, "{judged}");
    assert!(!word(&judged["summary"]).is_empty());
    let story = service.client.json("/v1/studies/2")["members"][0]["story"].to_string();
    assert_contains!(story, "fast_shear");
    // Its effect is added as any other.
    let name = word(&record["extension"]["file"]["name"]);
    assert_eq!(name, "fast_shear@1.toml");
    let extended = service.extend(second, "fast_shear");
    service.wait_for(extended, "finished");

    // The measurements that found the law do not count, also where a study leaves one of them out.
    let runs = hidden_law().runs;
    let last = runs.lines().rfind(|line| line.ends_with(",fit"));
    let fewer = hidden_law().in_runs(&format!("{}\n", last.expect("a fitted run")), "");
    let (third, record) = searched(&service, &fewer);
    assert!(explanation(&record, "fast_shear").is_some());
    let laws = service.client.json("/v1/library");
    let law = &laws[0];
    assert_eq!(
        (&law["name"], &law["found_in"]),
        (&"fast_shear".into(), &1.into())
    );
    let studies: Vec<(i64, bool, &str)> = items(&law["studies"])
        .map(|study| {
            (
                study["calibration"].as_i64().unwrap(),
                study["counts"] == true,
                word(&study["standing"]),
            )
        })
        .collect();
    assert_eq!(studies, [(second, true, "held"), (third, false, "held")]);
    assert_eq!(law["counted"], 1);
    assert_eq!(law["log_bayes_factor"], law["studies"][0]["log_bayes_factor"]);
    let listed = library(&service, &["list"]).success();
    assert_contains!(listed, "held in 1 of 1 study that counts");
    assert_contains!(listed, "(not counted: the measurements count elsewhere)");

    let removed = library(&service, &["remove", "fast_shear"]).success();
    assert_eq!(removed, "later searches do not try fast_shear\n");
    let refusal = library(&service, &["remove", "fast_shear"]).refusal();
    assert_contains!(refusal, "there is no law of the library fast_shear");
    let (_, record) = searched(&service, &other_rig.in_job("seed = 1", "seed = 3"));
    assert!(explanation(&record, "fast_shear").is_none());
}

#[test]
fn a_law_that_would_stop_a_search_is_refused() {
    let service = Service::start(&[]);
    let always = "name = \"always\"\nsummary = \"s\"\nsource = \"s\"\nshear = \"0.9 * tau\"\n";
    let refused = service
        .client
        .post("/v1/library", &serde_json::json!({ "text": always }));
    assert_eq!(refused.status, 422, "{}", refused.body);
    assert_contains!(refused.body, "needs a strength");
    let neither = service.client.post(
        "/v1/library",
        &serde_json::json!({"text": GAIN, "law": "my_gain"}),
    );
    assert_eq!(neither.status, 400, "{}", neither.body);
    // Two files of one effect could not stand in one model.
    let two = "[discovery]\ncandidate_files = [\"gain.toml\", \"same.toml\"]\n[sampler]";
    let job = Job::small()
        .in_job("[sampler]", two)
        .beside("gain.toml", GAIN)
        .beside("same.toml", GAIN);
    let experiment = service.create("/v1/experiments", &job.experiment_json())["id"].take();
    let new = serde_json::json!({"experiment": experiment, "toml": job.job, "files": job.effect_files()});
    let refused = service.client.post("/v1/calibrations", &new);
    assert_eq!(refused.status, 422, "{}", refused.body);
    assert_contains!(refused.body, "two files of the effect");
}

#[test]
fn a_law_of_the_library_is_the_last_version_of_its_name() {
    let service = Service::start(&[]);
    let added = |text: &str| {
        let added = service
            .client
            .post("/v1/library", &serde_json::json!({ "text": text }));
        assert_eq!(added.status, 201, "{}", added.body);
        added.json()["version"].as_i64()
    };
    assert_eq!(added(GAIN), Some(1));
    assert_eq!(added(GAIN), Some(1));
    assert_eq!(added(&GAIN.replace("prior = 0.25", "prior = 0.5")), Some(2));
    let laws = service.client.json("/v1/library");
    assert_eq!(items(&laws).count(), 1);
    assert_eq!((&laws[0]["version"], &laws[0]["counted"]), (&2.into(), &0.into()));
}

#[test]
fn a_job_names_candidates_by_their_files() {
    let candidates = "[discovery]\napply = \"ask\"\ncandidate_files = [\"gain.toml\"]\n[sampler]";
    let job = Job::late_shear()
        .in_job("[sampler]", candidates)
        .beside("gain.toml", GAIN);
    let service = Service::start(&["--local-workers", "2"]);
    let (id, record) = searched(&service, &job);
    let judged = explanation(&record, "my_gain").expect("the candidate is tried");
    assert!(float(&judged["probability"]) < 0.5, "{judged}");
    // A model that has the effect has it no longer as a candidate.
    let extended = service.client.post(
        &format!("/v1/calibrations/{id}/extend"),
        &serde_json::json!({"effect_file": {"name": "gain.toml", "text": GAIN}}),
    );
    assert_eq!(extended.status, 201, "{}", extended.body);
    let extended = extended.json()["id"].as_i64().expect("an id");
    service.wait_for(extended, "finished");
    let search = service.client.post(
        &format!("/v1/calibrations/{extended}/discovery"),
        &serde_json::json!({}),
    );
    service.wait_for(search.json()["id"].as_i64().expect("an id"), "finished");
    let record = service.result(extended, "discovery");
    assert_eq!(record["given"], serde_json::json!(["my_gain"]));
    assert!(explanation(&record, "my_gain").is_none());
}
