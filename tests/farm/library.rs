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

    // Another rig: the same law with one run less. It is named, and it is said in words of its own.
    let last = hidden_law()
        .runs
        .lines()
        .rfind(|line| line.ends_with(",fit"))
        .map(|line| format!("{line}\n"));
    let other_rig = hidden_law().in_runs(&last.expect("a fitted run"), "");
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

    // The measurements that found the law do not count, also in another study.
    let (third, record) = searched(&service, &hidden_law().in_job("seed = 1", "seed = 2"));
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
