//! Users' files by the command line and by REST: from a spreadsheet to a calibration.

use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{items, word};
use farm_tests::programs::{call, coordinator, run};
use farm_tests::service::Service;
use farm_tests::workspace::{data, root};
use serde_json::{Value, json};

fn example(file: &str) -> PathBuf {
    root().join("examples/import-german").join(file)
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

/// Imports the German example by a map into a folder.
fn import(map: &Path, folder: &Path) -> farm_tests::programs::Ended {
    let (file, output) = (
        shown(&example("Messung_Sand.xlsx")),
        shown(&folder.join("runs.csv")),
    );
    call(
        "coordinator import {} --map {} --output {}",
        &[&file, &shown(map), &output],
    )
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).expect("a text")
}

/// Compares the numbers of runs with those of the data that a table was made from; returns how many are compared.
#[track_caller]
fn same_numbers(runs: &str, made_from: &str, share: f64) -> usize {
    let rows = |text: &str| -> Vec<Vec<String>> {
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        lines
            .map(|line| line.split(',').map(str::to_owned).collect())
            .collect()
    };
    let (found, expected) = (rows(runs), rows(made_from));
    assert_eq!(found.len(), expected.len());
    let number = |rows: &[Vec<String>], row: usize, name: &str| -> f64 {
        let at = rows[0].iter().position(|column| column == name);
        rows[row][at.expect("the column")].parse().expect("a number")
    };
    let mut compared = 0;
    for row in 1..found.len() {
        for name in [
            "slip",
            "wheel_load_n",
            "sled_speed_m_s",
            "drawbar_pull_n",
            "torque_n_m",
            "sinkage_m",
        ] {
            let (a, b) = (number(&found, row, name), number(&expected, row, name));
            assert!(
                (a - b).abs() <= share * b.abs(),
                "{name} of {}: {a}, {b}",
                found[row][0]
            );
            compared += 1;
        }
    }
    compared
}

#[test]
fn a_german_spreadsheet_becomes_the_runs_that_it_was_made_from() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = import(&example("map.toml"), folder.path()).success();
    assert!(output.ends_with("runs.csv: 40 runs\n"), "{output}");
    assert_contains!(
        output,
        "kept as notes, no columns of runs.csv: Drehzahl [U/min], Bemerkung"
    );
    let runs = text(&folder.path().join("runs.csv"));
    assert_eq!(
        runs,
        text(&example("runs.csv")),
        "the committed runs.csv is that of the map"
    );
    let notes = text(&folder.path().join("runs-notes.csv"));
    assert!(
        notes.starts_with("run,Drehzahl [U/min],Bemerkung\nV01,0.76394373,Sand neu aufbereitet\n"),
        "{notes}"
    );
    let made_from = text(&root().join("examples/hidden-effect/runs.csv"));
    assert_eq!(same_numbers(&runs, &made_from, 1e-6), 240);
    // The program reads the files that it has written.
    for file in ["experiment.toml", "job.toml"] {
        std::fs::copy(example(file), folder.path().join(file)).expect("a copy");
    }
    let job = text(&folder.path().join("job.toml")).replace("[sampler]", "[sampler]\nalgorithm = \"lm\"");
    std::fs::write(folder.path().join("job.toml"), job).expect("written");
    let checked = run(coordinator(["check", &shown(&folder.path().join("job.toml"))])).success();
    assert_contains!(checked, "24 fit runs with 72 measurements");
}

#[test]
fn a_german_text_with_a_row_of_means_becomes_a_calibration_with_held_out_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let table = shown(&data("german-table/Messung.csv"));
    let guessed = run(coordinator(["import", &table, "--guess"]));
    assert!(
        guessed
            .stderr
            .contains("note: the file is read as windows-1252, which it does not state\n"),
        "{}",
        guessed.stderr
    );
    let proposed = guessed.success();
    assert!(proposed.ends_with('\n'), "{proposed}");
    assert_contains!(
        proposed,
        "words = { \"Kontrolle\" = \"holdout\", \"neu geharkt\" = \"fit\" }"
    );
    let import = |map: &str| {
        std::fs::write(at("map.toml"), map).expect("written");
        let (map, output) = (shown(&at("map.toml")), shown(&at("runs.csv")));
        call(
            "coordinator import {} --map {} --output {}",
            &[&table, &map, &output],
        )
    };
    let answered =
        proposed
            .replacen("value = \"?\"", "value = \"w\"", 1)
            .replacen("value = \"?\"", "value = \"s\"", 1);
    let refused = import(&answered);
    assert!(
        refused
            .stderr
            .contains("Messung.csv line 44: the row \"Mittelwert\" is no run: skip it with `skip = [44]`"),
        "{}",
        refused.stderr
    );
    assert!(!refused.stderr.contains("fill_down"), "{}", refused.stderr);
    assert!(refused.refusal().starts_with("1 mistake; "));
    let output = import(&format!("skip = [44]\n{answered}")).success();
    assert_contains!(output, "left out, as the map says: 44\n");
    assert!(output.ends_with("runs.csv: 40 runs\n"), "{output}");
    let job = Job::small();
    let runs = text(&at("runs.csv"));
    assert_eq!(same_numbers(&runs, &job.runs, 1e-9), 240);
    assert_eq!(runs.lines().filter(|line| line.ends_with(",holdout")).count(), 16);
    let fitted = Job { runs, ..job }.in_job(
        "algorithm = \"tmcmc\"\nparticles = 60\nmoves = [2, 4]",
        "algorithm = \"lm\"",
    );
    let path = shown(&fitted.write(&at("job")));
    run(coordinator(["run", &path, "--out", &shown(&at("out"))])).success();
    let summary: Value = serde_json::from_str(&text(&at("out").join("summary.json"))).expect("JSON");
    let held_out = &summary["calibrations"][0]["error"]["holdout"]["all"]["rmse_sigma"];
    assert!(held_out.as_f64().is_some_and(|error| error < 2.0), "{held_out}");
}

#[test]
fn what_is_guessed_is_refused_until_its_questions_are_answered() {
    let folder = tempfile::tempdir().expect("a folder");
    let map = folder.path().join("map.toml");
    let guessed = call(
        "coordinator import {} --guess",
        &[&shown(&example("Messung_Sand.xlsx"))],
    )
    .success();
    std::fs::write(&map, &guessed).expect("written");
    let refused = import(&map, folder.path());
    assert_contains!(
        refused.stderr,
        "wheel: value = \"?\" asks for an answer",
        "soil: value = \"?\" asks for an answer",
        "r: value = \"?\" asks for an answer",
        "error: 3 mistakes; "
    );
    assert!(!folder.path().join("runs.csv").exists());
    refused.refusal();
    let answered = guessed
        .replacen("value = \"?\"", "value = \"w\"", 1)
        .replacen("value = \"?\"", "value = \"s\"", 1)
        .replacen("value = \"?\"", "value = 12.5", 1)
        .replacen("unit = \"?\"", "unit = \"cm\"", 1);
    std::fs::write(&map, answered).expect("written");
    import(&map, folder.path()).success();
    assert_eq!(text(&folder.path().join("runs.csv")), text(&example("runs.csv")));
}

#[test]
fn every_mistake_is_printed_with_its_cell_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let map = folder.path().join("map.toml");
    let wrong = text(&example("map.toml"))
        .replace("\"Schlupf [%]\"", "\"Schlupf\"")
        .replace("unit = \"kN\"", "unit = \"KN\"")
        .replace("\"Zugkraft [N]\"", "\"Bemerkung\"");
    std::fs::write(&map, wrong).expect("written");
    let ended = import(&map, folder.path());
    assert_contains!(
        ended.stderr,
        "no column has the title \"Schlupf\"; did you mean \"Schlupf [%]\"",
        "unknown unit \"KN\"; did you mean \"kN\"",
        "Messung_Sand.xlsx, sheet \"Messung\", cell J5, column \"Bemerkung\": \"Sand neu aufbereitet\" is no number"
    );
    assert!(!folder.path().join("runs.csv").exists());
    ended.refusal();
    let absent = run(coordinator(["import", "nowhere.csv", "--guess"])).refusal();
    assert!(absent.starts_with("nowhere.csv: No such file"), "{absent}");
}

#[test]
fn a_service_imports_and_guesses_and_its_examples_hold() {
    let service = Service::start(&[]);
    let content = BASE64_STANDARD.encode(std::fs::read(example("Messung_Sand.xlsx")).expect("the file"));
    let guess = service.client.post(
        "/v1/import/guess",
        &json!({"name": "Messung_Sand.xlsx", "content_base64": content}),
    );
    assert_eq!(guess.status, 200, "{}", guess.json());
    let guess = guess.json();
    assert_eq!(guess["sheet"], "Messung");
    assert_eq!(guess["decimal"], ",");
    let ask = |map: &str| {
        let requested = json!({"name": "Messung_Sand.xlsx", "content_base64": content, "map": map});
        let answer = service.client.post("/v1/import", &requested);
        assert_eq!(answer.status, 200);
        answer.json()
    };
    let open = ask(word(&guess["map"]));
    assert_eq!(open["runs"], Value::Null);
    let fields: Vec<&str> = items(&open["complaints"])
        .filter_map(|c| c["field"].as_str())
        .collect();
    assert!(fields.contains(&"wheel"), "{fields:?}");
    assert!(fields.contains(&"r"), "{fields:?}");
    let right = ask(&text(&example("map.toml")));
    assert_eq!(right["runs"].as_str(), Some(text(&example("runs.csv")).as_str()));
    let bad = service.client.post(
        "/v1/import",
        &json!({"name": "a", "content_base64": "*", "map": ""}),
    );
    assert_eq!(bad.status, 422);
    assert_eq!(bad.json()["error"]["type"], "invalid_file");
    // The examples of the document are requests that work, and every route says what it does.
    let document = service.client.json("/openapi.json");
    for (path, id) in [
        ("/v1/import", "import_table"),
        ("/v1/import/guess", "guess_import_map"),
    ] {
        let operation = &document["paths"][path]["post"];
        assert_eq!(operation["operationId"], json!(id));
        assert_eq!(operation["tags"], json!(["import"]));
        assert!(operation["summary"].is_string(), "{operation}");
        assert!(operation["description"].is_string(), "{operation}");
        let body = &operation["requestBody"]["content"]["application/json"]["example"];
        let answer = service.client.post(path, body);
        assert_eq!(answer.status, 200, "{}", answer.json());
        assert_eq!(
            answer.json()["complaints"].as_array().map_or(0, Vec::len),
            0,
            "{}",
            answer.json()
        );
    }
}
