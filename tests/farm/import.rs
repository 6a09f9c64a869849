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

/// The first time of the recordings `[s]`: that of the bags, which `coordinator/import/tests/make_bags.py` wrote.
const BEGIN_S: f64 = 1_637_060_000.0;

/// Returns the kinematics of a run of 3 s without titles, in steps of 2 to 15 ms: position, speed, angle, depth, two times. The wheel stands for
/// 0.5 s, then sinks by 4 mm/s from `depth_mm`.
fn kinematics(depth_mm: f64) -> String {
    let mut text = String::new();
    let mut t_ms = 0;
    for step_ms in [15, 2, 14, 9, 13, 5].iter().cycle() {
        let t_s = f64::from(t_ms) / 1000.0;
        let (moved_s, speed) = if t_s < 0.5 { (0.0, 0) } else { (t_s - 0.5, 10) };
        let (x, z) = (10.0 * moved_s, depth_mm + 4.0 * moved_s);
        text += &format!("{x:.4}\t{speed}\t15\t{z:.4}\t{t_ms}\t{:.6}\n", BEGIN_S + t_s);
        t_ms += step_ms;
        if t_ms > 3000 {
            break;
        }
    }
    text
}

/// Returns the map of raw recordings in the document, and the files that it needs.
fn recordings() -> (String, Vec<(String, Vec<u8>)>) {
    let document = text(&root().join("docs/import.md"));
    let (_, map) = document
        .split_once("<!-- a test runs this map -->\n```toml\n")
        .expect("the map of the document");
    let (map, _) = map.split_once("```\n").expect("its end");
    let bag = |name: &str| {
        let path = root().join("coordinator/import/tests/files").join(name);
        std::fs::read(path).expect("a bag")
    };
    let mut files = vec![("grouser_zero.bag".to_owned(), bag("zero.bag"))];
    for (name, depth_mm) in [("grouser_s20_v10_1", -32.5), ("grouser_s-5.5_v25_1", 57.0)] {
        files.push((format!("{name}.txt"), kinematics(depth_mm).into_bytes()));
        files.push((format!("{name}.bag"), bag("run.bag")));
    }
    (map.to_owned(), files)
}

/// Compares the runs of the recordings with what they were made from.
#[track_caller]
fn assert_recorded(runs: &str) {
    let mut lines = runs.lines();
    let titles = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,sinkage_m";
    assert_eq!(lines.next(), Some(titles));
    let mut names = Vec::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        names.push(cells[..4].join(","));
        let near = |at: usize, expected: f64, tolerance: f64| {
            let value: f64 = cells[at].parse().expect("a number");
            assert!(
                (value - expected).abs() < tolerance,
                "{value}, {expected}: {line}"
            );
        };
        near(4, 150.0, 1e-6);
        // 20 N + 2 N/s t and 4 mm/s (t - 0.5 s), averaged from 1 to 2 s.
        near(6, 23.0, 0.03);
        near(7, 0.004, 6e-5);
    }
    names.sort_unstable();
    let expected = [
        "grouser_s-5.5_v25_1,grouser,sand,-0.055",
        "grouser_s20_v10_1,grouser,sand,0.2",
    ];
    assert_eq!(names, expected);
}

#[test]
fn raw_recordings_of_a_folder_become_runs_by_the_map_of_the_document() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let (map, files) = recordings();
    std::fs::create_dir(at("recordings")).expect("a folder");
    for (name, content) in &files {
        std::fs::write(at("recordings").join(name), content).expect("written");
    }
    std::fs::write(at("map.toml"), &map).expect("written");
    let import = |recordings: &Path| {
        let (map, output) = (shown(&at("map.toml")), shown(&at("runs.csv")));
        call(
            "coordinator import {} --map {} --output {}",
            &[&shown(recordings), &map, &output],
        )
    };
    let ended = import(&at("recordings"));
    assert_contains!(ended.stderr, "note: 2 of 5 files of ");
    let output = ended.success();
    assert!(output.ends_with("runs.csv: 2 runs\n"), "{output}");
    assert_recorded(&text(&at("runs.csv")));
    std::fs::write(at("map.toml"), map.replacen("file = ", "# ", 1)).expect("written");
    let refused = import(&at("recordings")).refusal();
    assert!(refused.contains("is a folder: `file = "), "{refused}");
}

#[test]
fn a_service_imports_recordings_with_the_files_beside_them() {
    let service = Service::start(&[]);
    let (map, files) = recordings();
    let file = |(name, content): &(String, Vec<u8>)| json!({"name": name, "content_base64": BASE64_STANDARD.encode(content)});
    let ask = |others: Vec<Value>| {
        let mut body = file(&files[1]);
        body["map"] = json!(map);
        body["others"] = json!(others);
        let answer = service.client.post("/v1/import", &body);
        assert_eq!(answer.status, 200, "{}", answer.json());
        answer.json()
    };
    let all = ask(files.iter().map(file).collect());
    assert_recorded(all["runs"].as_str().unwrap_or_else(|| panic!("{all}")));
    let alone = ask(Vec::new());
    let said: Vec<&str> = items(&alone["complaints"])
        .map(|complaint| word(&complaint["message"]))
        .collect();
    assert_eq!(said, ["[join.force]: there is no such file among `others`"]);
}
