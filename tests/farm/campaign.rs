//! A campaign that is followed: further runs change posterior, evidence and verdict as a new calibration does.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::float;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use serde_json::{Value, json};

/// The header of the runs, the fitted ones of two slips, which a campaign begins with, and the other fitted ones.
fn parts(runs: &str) -> (String, Vec<String>, Vec<String>) {
    let mut lines = runs.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().expect("titles").to_owned();
    let fitted = lines.filter(|line| line.ends_with(",fit")).map(str::to_owned);
    let is_first = |line: &String| ["0.2", "0.6"].contains(&line.split(',').nth(3).expect("a slip"));
    let (first, more) = fitted.partition(is_first);
    (header, first, more)
}

fn table(header: &str, rows: &[String]) -> String {
    format!("{header}\n{}\n", rows.join("\n"))
}

/// The small job with the runs that its campaign begins with, the header, and the further runs.
fn begun() -> (Job, String, Vec<String>) {
    let job = Job::small();
    let (header, first, more) = parts(&job.runs);
    let runs = table(&header, &first);
    (Job { runs, ..job }.sampler(1000, [2, 8], 1), header, more)
}

fn followed(service: &Service, id: i64, runs: &str) -> Value {
    let answer = service
        .client
        .post(&format!("/v1/calibrations/{id}/follow"), &json!({"runs": runs}));
    assert_eq!(answer.status, 200, "{}", answer.body);
    serde_json::from_str(&answer.body).expect("JSON")
}

#[test]
fn following_further_runs_equals_calibrating_again() {
    let (job, header, more) = begun();
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.submit(&job);
    service.wait_for(id, "finished");
    let one = followed(&service, id, &table(&header, &more[..1]));
    assert_eq!(one["models"][0]["method"], "reweighted", "{one}");
    let all = followed(&service, id, &table(&header, &more));
    let model = &all["models"][0];
    assert!(
        ["reweighted", "drawn"].contains(&model["method"].as_str().expect("a word")),
        "{model}"
    );
    assert!(float(&model["ess"]) > 100.0, "{model}");

    // The whole calibration, as another study.
    let (_, first, _) = parts(&Job::small().runs);
    let rows = [first, more.clone()].concat();
    let again = service.submit(&Job {
        runs: table(&header, &rows),
        ..job
    });
    service.wait_for(again, "finished");
    let evidence = float(&service.result(again, "summary")["calibrations"][0]["log_evidence"]);
    assert!(
        (float(&model["log_evidence"]) - evidence).abs() < 0.5,
        "{model} {evidence}"
    );
    let parameters = all["parameters"].as_array().expect("parameters");
    assert_eq!(parameters.len(), 4);
    let csv = service.posterior_csv(again);
    let mut lines = csv.lines();
    let titles: Vec<&str> = lines.next().expect("titles").split(',').collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| {
            line.split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        })
        .collect();
    for parameter in parameters {
        let column = titles
            .iter()
            .position(|title| parameter["name"] == *title)
            .expect("a parameter");
        let count = rows.len() as f64;
        let mean = rows.iter().map(|row| row[column]).sum::<f64>() / count;
        let sd = (rows.iter().map(|row| (row[column] - mean).powi(2)).sum::<f64>() / count).sqrt();
        let off = (float(&parameter["mean"]) - mean) / sd;
        let ratio = float(&parameter["sd"]) / sd;
        assert!(
            off.abs() < 0.3 && (0.75..1.33).contains(&ratio),
            "{parameter} {mean} {sd}"
        );
    }
    // A second answer has the same bits.
    assert_eq!(all, followed(&service, id, &table(&header, &more)));
}

#[test]
fn a_run_that_contradicts_all_others_is_said_at_once() {
    let (job, header, more) = begun();
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out").display().to_string();
    run(coordinator(["run", &path, "--out", &out])).success();
    let watched = |rows: &[String]| {
        let file = folder.path().join("runs.csv");
        std::fs::write(&file, table(&header, rows)).expect("the runs");
        let file = file.display().to_string();
        run(coordinator(["watch", &file, "--out", &out, "--once"])).success()
    };
    let right = watched(&more[..2]);
    assert_contains!(right, "2 further runs", "verdict: ", "effective draws");
    assert!(!right.contains("CONTRADICTS"), "{right}");
    // The wheel that slipped on its shaft.
    let mut cells: Vec<String> = more[0].split(',').map(str::to_owned).collect();
    let pull: f64 = cells[8].parse().expect("a pull");
    cells[8] = (pull + 30.0).to_string();
    let wrong = watched(&[cells.join(",")]);
    assert_contains!(wrong, "CONTRADICTS: run ", "drawbar_pull_n", "look at sensor");
}

#[test]
fn a_malformed_run_is_refused_with_its_line() {
    let (job, header, more) = begun();
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.submit(&job);
    service.wait_for(id, "finished");
    let path = format!("/v1/calibrations/{id}/follow");
    let wrong = more[0].replace(",fit", ",maybe");
    let refused = service
        .client
        .post(&path, &json!({"runs": table(&header, &[wrong])}));
    assert_eq!(refused.status, 422, "{}", refused.body);
    assert_contains!(refused.body, "line 2");
    let unknown = service
        .client
        .post("/v1/calibrations/99/follow", &json!({"runs": ""}));
    assert_eq!(unknown.status, 404);
}
