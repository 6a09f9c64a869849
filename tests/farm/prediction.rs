//! Predictions of conditions of one's own, and decisions: by the command line, by a service, and as the tutorial has them.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{float, word};
use farm_tests::programs::{Ended, coordinator, run};
use farm_tests::service::Service;
use farm_tests::workspace::{root, text};
use serde_json::{Value, json};

const DECISION: &str = "[decision]\nloss = \"20 * energy_j_m + 5000 * stuck\"\nrun_cost = 1\n\
    [[decision.options]]\nname = \"climb\"\ncondition = { slope_deg = 6, wheel_load_n = 100 }\n\
    [[decision.options]]\nname = \"cliff\"\ncondition = { slope_deg = 60, wheel_load_n = 100 }\n\
    [[decision.options]]\nname = \"stay\"\nloss = \"3000\"\n";

/// Runs the small job; its folder.
fn calibrated(folder: &Path) -> String {
    let job = Job::small().write(&folder.join("job")).display().to_string();
    let out = folder.join("out").display().to_string();
    run(coordinator(["run", &job, "--out", &out])).success();
    out
}

#[test]
fn the_decision_of_a_job_is_in_its_report() {
    let job = Job::small().in_job("[sampler]", &format!("{DECISION}[sampler]"));
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out");
    let shown = out.display().to_string();
    run(coordinator(["run", &path, "--out", &shown])).success();
    let report = text(&out.join("report.html"));
    assert_contains!(report, "/v1/calibrations/1/decision", "\"best\":\"climb\"");
    // A decision by a file changes nothing in the folder, but a report of its own has it.
    let file = folder.path().join("decision.toml").display().to_string();
    std::fs::write(&file, DECISION.replace("\"3000\"", "\"10\"")).expect("the decision");
    let own = folder.path().join("own.html");
    verb(&["decide", &file, "--report", &own.display().to_string()], &shown).success();
    assert_contains!(text(&own), "\"best\":\"stay\"");
    assert_eq!(text(&out.join("report.html")), report);
}

fn verb(words: &[&str], out: &str) -> Ended {
    run(coordinator([words, &["--out", out]].concat()))
}

fn json_of(words: &[&str], out: &str) -> Value {
    let printed = verb(&[words, &["--format", "json"]].concat(), out).success();
    serde_json::from_str(&printed).expect("JSON")
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap_or_else(|| panic!("a list in {value}"))
}

fn quantity<'a>(run: &'a Value, name: &str) -> &'a Value {
    let mut quantities = list(&run["quantities"]).iter();
    let found = quantities.find(|quantity| quantity["name"] == name);
    found.unwrap_or_else(|| panic!("{name} in {run}"))
}

#[test]
fn the_condition_of_a_held_out_run_is_predicted_as_that_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = calibrated(folder.path());
    let table = text(&Path::new(&out).join("predictions.csv"));
    let mut lines = table.lines();
    let titles: Vec<&str> = lines.next().expect("titles").split(',').collect();
    let column = |name: &str| titles.iter().position(|title| *title == name).expect("a column");
    let held_out: Vec<Vec<&str>> = lines
        .map(|line| line.split(',').collect::<Vec<&str>>())
        .filter(|cells| cells[column("use")] == "holdout" && cells[column("channel")] == "drawbar_pull")
        .collect();
    let mut plan = "run,slip,wheel_load_n,sled_speed_m_s\n".to_owned();
    for cells in &held_out {
        let of = |name: &str| cells[column(name)];
        let row = [of("run"), of("slip"), of("wheel_load_n"), of("sled_speed_m_s")];
        plan += &(row.join(",") + "\n");
    }
    let file = folder.path().join("plan.csv").display().to_string();
    std::fs::write(&file, plan).expect("the plan");
    let predicted = json_of(&["predict", "1", "--plan", &file], &out);
    let runs = list(&predicted["runs"]);
    assert!(runs.len() > 10 && runs.len() == held_out.len(), "{predicted}");
    for (run, cells) in runs.iter().zip(&held_out) {
        let stored = |name: &str| cells[column(name)].parse::<f64>().expect("a number");
        let pull = quantity(run, "drawbar_pull_n");
        for (new, old) in [
            (float(&pull["mean"]), "model"),
            (float(&pull["measurement"][0]), "model_q05"),
            (float(&pull["measurement"][1]), "model_q95"),
            (float(&pull["corrected"]), "corrected"),
            (float(&pull["corrected_measurement"][1]), "corrected_q95"),
        ] {
            let expected = stored(old);
            assert!(
                (new - expected).abs() < 1e-9 * expected.abs().max(1.0),
                "{old} {new} {expected}"
            );
        }
        // With one model, all models are the model, and an interval of the parameters lies within that of a measurement.
        assert_eq!(pull["parameters"], pull["models"]);
        assert!(float(&pull["measurement"][0]) < float(&pull["parameters"][0]));
    }
    let again = json_of(&["predict", "1", "--plan", &file], &out);
    assert_eq!(
        predicted, again,
        "a prediction does not depend on the order of threads"
    );
}

#[test]
fn a_sweep_gives_a_curve_its_probabilities_and_the_slip_on_a_slope() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = calibrated(folder.path());
    let sweep =
        "predict --at wheel_load_n=100 --at sled_speed_m_s=0.02 --at slope_deg=18 --sweep slip=0.05:0.7:14";
    let mut words: Vec<&str> = sweep.split(' ').collect();
    words.extend(["--probability", "drawbar_pull_n > 31"]);
    let predicted = json_of(&words, &out);
    let runs = list(&predicted["runs"]);
    let chance = |run: &Value| float(&run["statements"][0]["measurement"]);
    assert!(chance(&runs[0]) < 0.05 && chance(&runs[13]) > 0.95, "{predicted}");
    let climb = &predicted["climbs"][0];
    assert!(float(&climb["probability"]) > 0.99, "{climb}");
    let slip = float(&climb["slip"]);
    // Where the wheel climbs, its balanced slope is that of the ground.
    let slope = |run: &Value| float(&quantity(run, "balanced_slope_deg")["mean"]);
    let after = runs
        .iter()
        .position(|run| float(&run["slip"]) > slip)
        .expect("a slip beyond");
    assert!(
        slope(&runs[after - 1]) < 18.2 && slope(&runs[after]) > 17.8,
        "{slip}"
    );
    assert_eq!(list(&runs[0]["beyond"]).len(), 0);
    assert_contains!(
        word(&runs[13]["beyond"][0]),
        "slip outside the fitted 0.0500 to 0.600"
    );

    let printed = verb(&words, &out).success();
    // Sentences are broken into lines.
    let printed = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_contains!(
        printed,
        "pulls its weight along 18.0 deg with P > 0.999 at slip 0.",
        "P(drawbar_pull_n > 31) in p1-1 = ",
        "beyond: slip outside the fitted 0.0500 to 0.600 (p1-13, p1-14)"
    );
    words.extend(["--format", "csv"]);
    let table = verb(&words, &out).success();
    let columns = table.lines().next().map(|line| line.split(',').count());
    // The probability of a measurement has a column of its own.
    let titles: Vec<&str> = table.lines().next().unwrap_or_default().split(',').collect();
    let at = titles
        .iter()
        .position(|title| *title == "measurement_mean")
        .expect("a column");
    let statements = table.lines().filter(|line| line.contains("drawbar_pull_n > 31"));
    let chances: Vec<f64> = statements
        .map(|line| line.split(',').rev().nth(titles.len() - 1 - at).expect("a cell"))
        .map(|cell| cell.parse().expect("a probability"))
        .collect();
    let expected: Vec<f64> = runs.iter().map(chance).collect();
    assert_eq!(chances.len(), expected.len());
    let mut pairs = chances.iter().zip(&expected);
    assert!(
        pairs.all(|(a, b)| (a - b).abs() < 1e-12),
        "{chances:?} {expected:?}"
    );
    assert!(
        table
            .lines()
            .skip(1)
            .all(|line| line.matches(',').count() + 1 >= columns.unwrap_or(99))
    );
    // Fourteen runs with nine quantities, the lateral force of an unmeasured channel among them, and one statement.
    assert!(table.lines().count() > 14 * 10, "{table}");
}

#[test]
fn the_grid_has_the_predictions_of_its_points() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = calibrated(folder.path());
    let service = Service::start_on(&format!("sqlite://{out}/grouser.db"), &["--read-only"]);
    let grid = service.client.json("/v1/calibrations/1/prediction-grid");
    let axes = ["slips", "wheel_loads_n", "speeds_m_s"].map(|name| list(&grid[name]));
    let points = list(&grid["wheels"][0]["points"]);
    assert_eq!(points.len(), axes.map(Vec::len).iter().product::<usize>());
    // A point in the middle, by slip, then load, then speed, as a plan of its own has it.
    let [slips, loads, speeds] = axes;
    let (slip, load, speed) = (float(&slips[4]), float(&loads[1]), float(&speeds[0]));
    let sled = if grid["holds_rim"] == true {
        speed * (1.0 - slip)
    } else {
        speed
    };
    let plan = format!("slip,wheel_load_n,sled_speed_m_s\n{slip},{load},{sled}\n");
    let asked = json!({"plan": plan, "draws": float(&grid["draws"]) as u64});
    let answer = service.client.post("/v1/calibrations/1/predict", &asked).json();
    let one = &answer["runs"][0];
    let point = &points[(4 * loads.len() + 1) * speeds.len()];
    for (stated, value) in list(&grid["quantities"]).iter().zip(list(&point["values"])) {
        let expected = quantity(one, word(&stated["name"]));
        let interval = if stated["is_measurement"] == true {
            "models_measurement"
        } else {
            "models"
        };
        let ends = [
            &expected["models_mean"],
            &expected[interval][0],
            &expected[interval][1],
        ];
        for (i, end) in ends.into_iter().enumerate() {
            let (found, end) = (float(&value[i]), float(end));
            // The noise of a measurement is drawn for each run, and the grid has other runs than the plan.
            let drawn = if i > 0 && stated["is_measurement"] == true {
                0.05
            } else {
                1e-5
            };
            assert!(
                (found - end).abs() <= drawn * end.abs(),
                "{stated} {i}: {found} {end}"
            );
        }
    }
    // The report carries the same.
    let report = service.client.get("/v1/calibrations/1/report").body;
    assert_contains!(report, "/v1/calibrations/1/prediction-grid");
    assert!(
        grid.to_string().len() < 60_000,
        "{} bytes",
        grid.to_string().len()
    );
}

#[test]
fn what_cannot_be_predicted_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = calibrated(folder.path());
    let file = folder.path().join("plan.csv").display().to_string();
    for (plan, more, reason) in [
        (
            "slip,load\n0.1,3\n",
            "",
            "plan.csv line 1: unknown column \"load\"",
        ),
        ("slip\n1.2\n", "", "plan.csv line 2: slip 1.2 must lie in [-1, 1)"),
        ("slip,wheel\n0.1,v\n", "", "plan.csv line 2: unknown wheel \"v\""),
        (
            "slip\n0.1\n",
            "--probability=pull>1",
            "statement \"pull>1\": character 1: ",
        ),
        (
            "slip\n0.1\n",
            "--sweep=slop=1:2:3",
            "the nearest known is \"slip\"",
        ),
    ] {
        std::fs::write(&file, plan).expect("the plan");
        let words = ["predict", "1", "--plan", &file, more];
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        assert_contains!(verb(&words, &out).refusal(), reason);
    }
    std::fs::write(&file, "wheel_load_n\n60\n120\n").expect("the plan");
    let none = ["predict", "1", "--at", "slip=0.1", "--draws", "0"];
    assert_contains!(
        verb(&none, &out).refusal(),
        "draws 0 of each model must be at least 1"
    );
    let many = ["predict", "1", "--plan", &file, "--sweep", "slip=0:0.8:6000"];
    assert_contains!(
        verb(&many, &out).refusal(),
        "12000 planned runs must be at most 10000"
    );
}

#[test]
fn options_are_ranked_by_their_expected_losses() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = calibrated(folder.path());
    let file = folder.path().join("decision.toml").display().to_string();
    std::fs::write(&file, DECISION).expect("the decision");
    let answer = json_of(&["decide", &file], &out);
    assert_eq!(word(&answer["best"]), "climb", "{answer}");
    let [climb, cliff, stay] = &list(&answer["options"])[..] else {
        panic!("three options");
    };
    assert!(float(&climb["expected_loss"]) < 3000.0 && float(&climb["stuck"]) < 0.01);
    assert!(float(&cliff["stuck"]) > 0.99 && float(&cliff["expected_loss"]) > 5000.0);
    assert!((float(&stay["expected_loss"]) - 3000.0).abs() < 1e-9 && stay["slip"] == Value::Null);
    // The best option is sure, so that no run can change it.
    assert!(float(&answer["probability_best"]) > 0.999);
    assert!(float(&answer["perfect_information"]).abs() < 1e-9);
    assert_eq!(answer["runs"][0]["is_worth_its_cost"], false);
    let by = &answer["decided_by"];
    let shares = ["model", "parameters", "noise"].map(|key| float(&by[key]));
    assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{by}");
    // The steep slope keeps the wheel at slips that no run was made at.
    assert_contains!(word(&cliff["beyond"][0]), "slip outside the fitted ");
    assert_eq!(list(&stay["beyond"]).len(), 0);
    let printed = verb(&["decide", &file], &out).success();
    assert_contains!(
        printed,
        "best:    climb, by ",
        "beyond:  slip outside the fitted "
    );

    let twin = "[[decision.options]]\nname = \"twin\"\ncondition = { slope_deg = 6, wheel_load_n = 100 }\n";
    std::fs::write(&file, format!("{DECISION}{twin}")).expect("the decision");
    let answer = json_of(&["decide", &file], &out);
    // Two equal options have equal errors, so that nothing is gained by telling them apart.
    assert!(
        float(&answer["margin"]).abs() < 1e-9 && float(&answer["margin_se"]).abs() < 1e-9,
        "{answer}"
    );
    assert!(float(&answer["perfect_information"]).abs() < 1e-9, "{answer}");

    std::fs::write(&file, DECISION.replace("energy_j_m", "energy")).expect("the decision");
    assert_contains!(
        verb(&["decide", &file], &out).refusal(),
        "decision.toml: [decision] loss of option \"climb\": character 6"
    );
}

#[test]
fn a_service_decides_by_the_job_and_one_that_only_reads_predicts() {
    let job = Job::small().in_job("[sampler]", &format!("{DECISION}[sampler]"));
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.submit(&job);
    service.wait_for(id, "finished");
    let path = |verb: &str| format!("/v1/calibrations/{id}/{verb}");
    let decided = service.client.post(&path("decide"), &json!({}));
    assert_eq!(decided.status, 200, "{}", decided.body);
    assert_contains!(decided.body, "\"best\":\"climb\"");
    // It is kept, and the report carries it; the next one takes its place.
    let kept = || service.client.get(&path("decision")).body;
    assert_eq!(kept(), decided.body);
    let other = DECISION.replace("\"3000\"", "\"10\"");
    let asked = service.client.post(&path("decide"), &json!({ "file": other }));
    assert_contains!(asked.body, "\"best\":\"stay\"");
    assert_eq!(kept(), asked.body);
    let report = service.client.get(&path("report")).body;
    assert_contains!(report, &format!("\"{}\":", path("decision")), "\"best\":\"stay\"");
    let unknown = service
        .client
        .post("/v1/calibrations/9/predict", &json!({"sweep": "slip=0:0.5:3"}));
    assert_eq!(unknown.status, 404);
    let nothing = service.client.post(&path("predict"), &json!({}));
    assert_eq!(nothing.status, 422, "{}", nothing.body);
}

/// Copies the files of a folder of examples.
fn copy(name: &str, to: &Path) {
    let target = to.join("examples").join(name);
    std::fs::create_dir_all(&target).expect("a folder");
    for entry in std::fs::read_dir(root().join("examples").join(name)).expect("the example") {
        let file = entry.expect("a file").path();
        let name = file.file_name().expect("a name");
        std::fs::copy(&file, target.join(name)).expect("a copy");
    }
}

#[test]
fn the_commands_of_the_tutorial_work_in_their_order() {
    let folder = tempfile::tempdir().expect("a folder");
    for example in ["hidden-effect", "slope-decision"] {
        copy(example, folder.path());
    }
    let program = coordinator(["--version"]).get_program().to_owned();
    let programs = Path::new(&program)
        .parent()
        .expect("a folder of programs")
        .to_owned();
    let paths = std::env::var("PATH").unwrap_or_default();
    let tutorial = text(&root().join("docs/prediction.md"));
    let mut printed = Vec::new();
    for block in tutorial.split("```sh\n").skip(1) {
        let (commands, _) = block.split_once("```").expect("the end of a block");
        let mut shell = std::process::Command::new("sh");
        shell.args(["-e", "-c", commands]).current_dir(&folder);
        shell.env("PATH", format!("{}:{paths}", programs.display()));
        printed.push(run(shell).success());
    }
    assert!(printed.len() >= 5, "{} blocks of commands", printed.len());
    let all = printed.concat();
    assert_contains!(all, "pulls its weight along 10.0 deg", "best:    ", "worth:   ");
}
