//! `summary.json` keeps its contract: every key exists with a value of its kind, which is null only where the contract allows it.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{float, item_count, items, word};
use farm_tests::programs::{coordinator, run, study};
use serde_json::Value;

/// The contract: on each line a path and the kind of its value. `*` stands for every element, `?` allows null. Nothing is missed below a
/// null.
const CONTRACT: &str = include_str!("../data/summary-contract.txt");

fn is(value: &Value, kind: &str) -> bool {
    match kind {
        "text" => value.is_string(),
        "count" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "flag" => value.is_boolean(),
        "list" => value.is_array(),
        "table" => value.is_object(),
        words => value
            .as_str()
            .is_some_and(|word| words.split('|').any(|allowed| allowed == word)),
    }
}

/// Notes a value below `value` that is missing or of the wrong kind.
fn check(value: &Value, path: &str, kind: &str, complaints: &mut Vec<String>) {
    let (key, rest) = path
        .split_once('.')
        .map_or((path, None), |(key, rest)| (key, Some(rest)));
    let inner: Vec<Option<&Value>> = match (key, value) {
        (_, Value::Null) => return,
        ("*", Value::Array(list)) => list.iter().map(Some).collect(),
        ("*", Value::Object(table)) => table.values().map(Some).collect(),
        _ => vec![value.get(key)],
    };
    for value in inner {
        match (value, rest, kind.strip_suffix('?')) {
            (None, ..) => complaints.push(format!("missing {path}")),
            (Some(value), Some(rest), _) => check(value, rest, kind, complaints),
            (Some(Value::Null), None, Some(_)) => {}
            (Some(value), None, optional) if !is(value, optional.unwrap_or(kind)) => {
                complaints.push(format!("{path} is {value}"));
            }
            _ => {}
        }
    }
}

/// Lists the values that are missing or of the wrong kind.
fn complaints(summary: &Value) -> Vec<String> {
    let mut complaints = Vec::new();
    for line in CONTRACT.lines() {
        let (path, kind) = line.split_once(' ').expect("a path and its kind");
        check(summary, path, kind, &mut complaints);
    }
    complaints
}

/// Returns the summary of a finished run.
fn summary(job: &Job) -> Value {
    study(job).1
}

#[test]
fn a_summary_keeps_the_contract() {
    let summary = summary(&Job::small());
    assert_eq!(complaints(&summary), Vec::<String>::new());
    let calibration = &summary["calibrations"][0];
    assert_eq!(item_count(&summary["calibrations"]), 1);
    assert_eq!(summary["status"].as_str(), Some("finished"));
    assert_eq!(summary["seed"].as_u64(), Some(1));
    assert_eq!(summary["model_kind"], "quasi_static");
    assert_eq!(calibration["algorithm"], "tmcmc");
    assert_eq!(
        calibration["parameters"].as_object().map(serde_json::Map::len),
        Some(4)
    );
    let last = calibration["stages"]
        .as_array()
        .and_then(|s| s.last())
        .expect("a stage");
    assert_eq!(last["tempering_exponent"].as_f64(), Some(1.0));
    // The mean of 24 equal numbers differs by rounding only.
    assert!(
        calibration["noise_sd"]["drawbar_pull"]
            .as_f64()
            .is_some_and(|sd| (sd - 1.2).abs() < 1e-12)
    );
    assert_eq!(calibration["error"]["fit"]["torque"]["runs"], 24);
    assert_eq!(calibration["error"]["holdout"]["sinkage"]["runs"], 16);
    let groups = items(&calibration["holdout_groups"]);
    let runs = groups.filter_map(|group| group["runs"].as_u64());
    assert_eq!(Some(runs.sum()), calibration["held_out_runs"].as_u64());
    assert_eq!(calibration["error"]["fit"]["lateral_force"], Value::Null);
    assert_eq!(summary["discovery"], Value::Null);
    assert_eq!(calibration["baseline"]["name"], "interpolation");
}

#[test]
fn a_summary_without_holdout_rows_and_with_unknown_noise_keeps_the_contract() {
    let job = Job::small();
    let rows: Vec<&str> = job
        .runs
        .lines()
        .filter(|line| !line.ends_with("holdout"))
        .collect();
    let job = Job {
        runs: rows.join("\n") + "\n",
        ..job.clone()
    }
    .in_experiment("torque_n_m = 0.15", "torque_n_m = \"unknown\"");
    let summary = summary(&job);
    assert_eq!(complaints(&summary), Vec::<String>::new());
    let calibration = &summary["calibrations"][0];
    assert_eq!(calibration["error"]["holdout"], Value::Null);
    assert_eq!(calibration["coverage90"]["holdout"], Value::Null);
    assert!(
        calibration["parameters"]["noise.torque_n_m"]["mean"].is_number(),
        "{calibration}"
    );
    assert!(
        calibration["noise_sd"]["torque"]
            .as_f64()
            .is_some_and(|sd| sd > 0.0),
        "{calibration}"
    );
}

#[test]
fn a_summary_of_a_fit_keeps_the_contract_and_its_point_stands_apart() {
    let job = super::point_fit::fit().in_experiment("torque_n_m = 0.15", "torque_n_m = \"unknown\"");
    let summary = summary(&job);
    assert_eq!(complaints(&summary), Vec::<String>::new());
    assert_eq!(summary["calibrations"], serde_json::json!([]));
    assert_eq!(item_count(&summary["point_estimates"]), 1);
    let estimate = &summary["point_estimates"][0];
    assert_eq!(estimate["algorithm"], "lm");
    assert_eq!(estimate["error"]["fit"]["torque"]["runs"], 24);
    assert_eq!(estimate["error"]["holdout"]["sinkage"]["runs"], 16);
    assert_eq!(estimate["baseline"]["name"], "interpolation");
    let sd = &estimate["sd"]["noise.torque_n_m"];
    assert!(
        estimate["parameters"]["noise.torque_n_m"].is_number(),
        "{estimate}"
    );
    assert!(sd.is_number(), "{estimate}");
}

/// Returns the small job with each fitted run made again in another session, in which the wheel sinks 2 mm deeper; the noise is 0.4 mm.
fn repeated_in_another_session() -> Job {
    let small = Job::small();
    let mut rows = small.runs.lines().filter(|line| !line.starts_with('#'));
    let header = rows.next().expect("a header");
    let sinkage = header.split(',').position(|column| column == "sinkage_m");
    let sinkage = sinkage.expect("a column of the sinkage");
    let twice = |line: &str| {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        let measured: f64 = fields[sinkage].parse().expect("a number");
        fields[sinkage] = (measured + 0.002).to_string();
        match line.ends_with("fit") {
            true => format!("{line},first day\nagain-{},second day\n", fields.join(",")),
            false => format!("{line},first day\n"),
        }
    };
    let rows: String = rows.map(twice).collect();
    Job {
        runs: format!("{header},session\n{rows}"),
        ..small.clone()
    }
}

#[test]
fn a_summary_says_what_repeats_tell_about_sessions() {
    let job = repeated_in_another_session();
    let summary = summary(&job);
    assert_eq!(complaints(&summary), Vec::<String>::new());
    // The loads are nominal and the other channels copied, so that their repeats are equal.
    let quantities: Vec<&str> = items(&summary["rig"])
        .map(|found| word(&found["quantity"]))
        .collect();
    assert_eq!(quantities, ["sinkage"]);
    let sinkage = &summary["rig"][0];
    assert!(float(&sinkage["probability"]) > 0.99, "{sinkage}");
    let [first, second] = [0, 1].map(|k| float(&sinkage["offsets"][k]["mean"]));
    assert!((second - first - 0.002).abs() < 0.0005, "{sinkage}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(folder.path()).display().to_string();
    let checked = run(coordinator(["check", &path])).success();
    assert_contains!(checked, "what the rig did");
    assert_contains!(checked, "w, sinkage mm");
}

#[test]
fn summaries_of_searches_keep_the_contract() {
    for job in super::search::searches() {
        assert_eq!(complaints(&summary(&job)), Vec::<String>::new());
    }
}

#[test]
fn the_check_notices_what_breaks_the_contract() {
    let good: Value = serde_json::json!({
        "experiment": "e", "seed": 1, "model_version": "1", "model_kind": "quasi_static", "status": "finished",
        "calibrations": [], "point_estimates": [], "rig": null, "flags": [], "discovery": null,
    });
    assert_eq!(complaints(&good), Vec::<String>::new());
    let broken = |key: &str, value: Value| {
        let mut summary = good.clone();
        summary[key] = value;
        complaints(&summary).len()
    };
    assert_eq!(broken("seed", "one".into()), 1);
    assert_eq!(broken("status", Value::Null), 1);
    assert_eq!(
        broken("flags", serde_json::json!([{"kind": "hunch", "text": ""}])),
        4
    );
    assert!(broken("calibrations", serde_json::json!([{}])) >= 14);
}

#[test]
fn a_held_out_run_that_the_model_refuses_costs_its_own_row_alone() {
    // No soil of the prior carries this load, which is far beyond the fitted ones.
    let beyond = "deep,w,s,0.3,20000.0,0.0133,0,1,100.0,10.0,0.1,,holdout\n";
    let small = Job::small();
    let with = Job {
        runs: small.runs.clone() + beyond,
        ..small.clone()
    }
    .in_job("[sampler]", "[sampler]\npoint_estimates = [\"lm\"]");
    let (text, summary) = study(&with);
    assert_eq!(complaints(&summary), Vec::<String>::new());
    let (_, without) = study(&small);
    let (calibration, before) = (&summary["calibrations"][0], &without["calibrations"][0]);
    // The numbers of the other runs are those without this one, to the bit.
    assert_eq!(calibration["log_evidence"], before["log_evidence"]);
    assert_eq!(calibration["coverage90"], before["coverage90"]);
    for channel in ["drawbar_pull", "torque", "sinkage"] {
        let error = &calibration["error"]["holdout"][channel];
        assert_eq!(error, &before["error"]["holdout"][channel]);
        assert_eq!(error["runs"], 16);
    }
    assert_eq!(calibration["error"]["holdout"]["all"]["unpredicted"], 3);
    let estimate = &summary["point_estimates"][0]["error"]["holdout"];
    assert_eq!(estimate["sinkage"]["runs"], 16);
    assert_eq!(estimate["all"]["unpredicted"], 3);
    assert_contains!(
        text,
        "\ndeep: the model refuses it at 60 of 60 final draws (no_support: ",
        "the model refuses 1 of 17 held-out runs: deep at 60 of 60 final draws",
        "errors and coverage are over the other 16 held-out runs"
    );
}
