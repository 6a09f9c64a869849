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

#[test]
fn who_watches_a_campaign_has_each_answer_as_an_event() {
    let (job, header, more) = begun();
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.submit(&job);
    service.wait_for(id, "finished");
    let first = followed(&service, id, &table(&header, &more[..1]));
    let (client, path) = (service.client.clone(), format!("/v1/calibrations/{id}/follow"));
    let (told, heard) = std::sync::mpsc::channel();
    let watcher = std::thread::spawn(move || {
        let mut count = 0;
        client.events(&path, |event, data| {
            assert_eq!(event, "followed");
            told.send(serde_json::from_str::<Value>(data).expect("JSON"))
                .expect("a listener");
            count += 1;
            count < 2
        })
    });
    // The answer before the watcher came, then the next one.
    assert_eq!(heard.recv().expect("an event"), first);
    let second = followed(&service, id, &table(&header, &more[..2]));
    assert_eq!(heard.recv().expect("an event"), second);
    assert_eq!(second["rows"], table(&header, &more[..2]));
    watcher.join().expect("a watcher");
    let unknown = service.client.get("/v1/calibrations/99/follow");
    assert_eq!(unknown.status, 404);
}

#[test]
fn a_search_ends_at_its_bound_and_the_answer_says_so() {
    let (job, header, more) = begun();
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.submit(&job);
    service.wait_for(id, "finished");
    let rows = table(&header, &more[..1]);
    let bounded = |max_evaluations: usize| -> Value {
        let body = json!({"runs": rows, "max_evaluations": max_evaluations});
        let answer = service
            .client
            .post(&format!("/v1/calibrations/{id}/follow"), &body);
        serde_json::from_str(&answer.body).expect("JSON")
    };
    let whole = followed(&service, id, &rows);
    let needed = whole["search"]["evaluations"].as_u64().expect("a number");
    assert_eq!(whole["search"]["is_at_bound"], false);
    assert!(needed > 100 && needed < 100_000, "{needed}");
    let ended = bounded(needed as usize - 1);
    let search = &ended["search"];
    assert_eq!(search["is_at_bound"], true, "{search}");
    assert!(search["evaluations"].as_u64().expect("a number") < needed);
    assert_contains!(
        ended["verdict"].as_str().expect("a sentence"),
        &format!(
            "not known: the search was ended at its bound of {} evaluations",
            needed - 1
        )
    );
    assert_eq!((&ended["next_runs"], &ended["stop"]), (&json!([]), &Value::Null));
    // Posterior and weights do not depend on the search.
    for part in ["models", "parameters", "expectations"] {
        assert_eq!(ended[part], whole[part], "{part}");
    }
    assert_eq!(bounded(needed as usize)["verdict"], whole["verdict"]);
}

#[test]
fn files_that_are_dropped_into_a_folder_become_rows() {
    let (job, header, more) = begun();
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out").display().to_string();
    run(coordinator(["run", &path, "--out", &out])).success();
    let dropped = folder.path().join("dropped");
    std::fs::create_dir(&dropped).expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(dropped.join(name), text).expect("a file");
    write("monday.csv", &table(&header, &more[..1]));
    let wrong = more[2].replace(",fit", ",maybe");
    write("tuesday.csv", &table(&header, &[more[1].clone(), wrong]));
    write("wednesday.csv", &table(&header, &more[3..4]));
    let watched = run(coordinator([
        "watch",
        &dropped.display().to_string(),
        "--out",
        &out,
        "--once",
    ]));
    let said = watched.stderr.clone();
    let printed = watched.success();
    let name = |line: &str| line.split(',').next().expect("a name").to_owned();
    assert_contains!(printed, &format!("2 further runs, the last {}", name(&more[3])));
    assert_contains!(said, "tuesday.csv line 3", "set apart");
    assert!(dropped.join("refused/tuesday.csv").exists() && !dropped.join("tuesday.csv").exists());
    let reason = std::fs::read_to_string(dropped.join("refused/tuesday.csv.txt")).expect("the reason");
    assert_contains!(reason, "line 3");
}
