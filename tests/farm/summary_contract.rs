//! `summary.json` keeps its contract: every key is there, of its kind, null only where that may be.

use farm_tests::job::Job;
use farm_tests::programs::study;
use serde_json::Value;

/// What a value must be.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Text,
    Count,
    Number,
    Flag,
    List,
    Table,
}

use Kind::{Count, Flag, List, Number, Table, Text};

fn is(value: &Value, kind: Kind) -> bool {
    match kind {
        Text => value.is_string(),
        Count => value.is_u64() || value.is_i64(),
        Number => value.is_number(),
        Flag => value.is_boolean(),
        List => value.is_array(),
        Table => value.is_object(),
    }
}

/// What is missing or of the wrong kind.
#[derive(Debug, Default)]
struct Complaints(Vec<String>);

impl Complaints {
    /// The value of a dotted path must be there; null counts where `null`. What is below a null is not missed.
    fn need<'a>(&mut self, table: &'a Value, path: &str, kind: Kind, null: bool) -> Option<&'a Value> {
        let mut value = table;
        for key in path.split('.') {
            if value.is_null() {
                return None;
            }
            let Some(inner) = value.get(key) else {
                self.0.push(format!("missing {path}"));
                return None;
            };
            value = inner;
        }
        if value.is_null() {
            if !null {
                self.0.push(format!("null {path}"));
            }
            return None;
        }
        if !is(value, kind) {
            self.0.push(format!("{path} is {value}"));
            return None;
        }
        Some(value)
    }

    fn one_of(&mut self, table: &Value, key: &str, words: &[&str]) {
        if let Some(word) = self.need(table, key, Text, false).and_then(Value::as_str)
            && !words.contains(&word)
        {
            self.0.push(format!("{key} \"{word}\" is not one of {words:?}"));
        }
    }

    fn errors(&mut self, table: &Value, part: &str) {
        let Some(channels) = table.as_object() else { return };
        if !channels.contains_key("all") {
            self.0.push(format!("missing {part}.all"));
        }
        for (name, channel) in channels.iter().filter(|(_, c)| !c.is_null()) {
            self.need(channel, "rmse_sigma", Number, true);
            if name != "all" {
                self.need(channel, "rmse", Number, true);
                self.need(channel, "runs", Count, true);
            }
        }
    }

    fn calibration(&mut self, calibration: &Value) {
        for (path, kind) in [
            ("effects", List),
            ("algorithm", Text),
            ("log_evidence", Number),
            ("log_evidence_se", Number),
            ("equilibrated", Flag),
            ("evaluations", Count),
            ("rejected", Count),
            ("wall_s", Number),
            ("stages", List),
            ("parameters", Table),
            ("error.fit", Table),
            ("error.holdout", Table),
            ("noise_sd", Table),
            ("baseline", Table),
            ("coverage90.fit", Number),
            ("coverage90.holdout", Number),
        ] {
            self.need(calibration, path, kind, true);
        }
        for stage in calibration["stages"].as_array().into_iter().flatten() {
            for key in ["tempering_exponent", "acceptance", "drift_z", "steps"] {
                self.need(stage, key, Number, true);
            }
        }
        for parameter in calibration["parameters"]
            .as_object()
            .into_iter()
            .flat_map(|p| p.values())
        {
            for key in ["mean", "sd", "q05", "q50", "q95", "map", "prior_mean", "prior_sd"] {
                self.need(parameter, key, Number, true);
            }
            self.need(parameter, "at_bound", Flag, true);
        }
        for part in ["fit", "holdout"] {
            self.errors(&calibration["error"][part], &format!("error.{part}"));
        }
    }
}

const FLAGS: [&str; 13] = [
    "trend",
    "chi2",
    "outlier",
    "conflict",
    "bound",
    "not_equilibrated",
    "no_information",
    "rejections",
    "order",
    "interpolation_beats",
    "worker",
    "incomplete",
    "plates_conflict",
];

fn complaints(summary: &Value) -> Vec<String> {
    let mut complaints = Complaints::default();
    for (key, kind) in [
        ("experiment", Text),
        ("seed", Count),
        ("model_version", Text),
        ("model_kind", Text),
        ("status", Text),
        ("calibrations", List),
        ("point_estimates", List),
        ("flags", List),
    ] {
        complaints.need(summary, key, kind, false);
    }
    complaints.need(summary, "discovery", Table, true);
    for calibration in summary["calibrations"].as_array().into_iter().flatten() {
        complaints.calibration(calibration);
    }
    for estimate in summary["point_estimates"].as_array().into_iter().flatten() {
        for (key, kind) in [
            ("algorithm", Text),
            ("parameters", Table),
            ("log_posterior", Number),
            ("error", Table),
            ("evaluations", Count),
        ] {
            complaints.need(estimate, key, kind, true);
        }
        for part in ["fit", "holdout"] {
            complaints.errors(&estimate["error"][part], &format!("error.{part}"));
        }
    }
    for flag in summary["flags"].as_array().into_iter().flatten() {
        complaints.one_of(flag, "kind", &FLAGS);
        complaints.need(flag, "text", Text, false);
        complaints.need(flag, "channel", Text, true);
        complaints.need(flag, "against", Text, true);
        complaints.need(flag, "p", Number, true);
    }
    complaints.0
}

/// The summary of a finished run.
fn summary(job: &Job) -> Value {
    study(job).1
}

#[test]
fn a_summary_keeps_the_contract() {
    let summary = summary(&Job::small());
    assert_eq!(complaints(&summary), Vec::<String>::new());
    let calibration = &summary["calibrations"][0];
    assert_eq!(summary["calibrations"].as_array().map(Vec::len), Some(1));
    assert_eq!(
        (summary["status"].as_str(), summary["seed"].as_u64()),
        (Some("finished"), Some(1))
    );
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
    // The mean of 24 equal numbers, rounding included.
    assert!(
        calibration["noise_sd"]["drawbar_pull"]
            .as_f64()
            .is_some_and(|sd| (sd - 1.2).abs() < 1e-12)
    );
    assert_eq!(calibration["error"]["fit"]["torque"]["runs"], 24);
    assert_eq!(calibration["error"]["holdout"]["sinkage"]["runs"], 16);
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
    assert_eq!(summary["point_estimates"].as_array().map(Vec::len), Some(1));
    let estimate = &summary["point_estimates"][0];
    assert_eq!(estimate["algorithm"], "lm");
    assert_eq!(estimate["error"]["fit"]["torque"]["runs"], 24);
    assert_eq!(estimate["error"]["holdout"]["sinkage"]["runs"], 16);
    assert_eq!(estimate["baseline"]["name"], "interpolation");
    let sd = &estimate["sd"]["noise.torque_n_m"];
    assert!(
        estimate["parameters"]["noise.torque_n_m"].is_number() && sd.is_number(),
        "{estimate}"
    );
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
        "calibrations": [], "point_estimates": [], "flags": [], "discovery": null,
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
    // A load that no soil of the prior carries before the wheel is buried, far beyond what is fitted.
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
    // What is said of the other runs is what is said without this one, to the bit.
    assert_eq!(calibration["log_evidence"], before["log_evidence"]);
    assert_eq!(calibration["coverage90"], before["coverage90"]);
    for channel in ["drawbar_pull", "torque", "sinkage"] {
        let error = &calibration["error"]["holdout"][channel];
        assert_eq!(error, &before["error"]["holdout"][channel]);
        assert_eq!(error["runs"], 16);
    }
    assert_eq!(calibration["error"]["holdout"]["all"]["unpredicted"], 3);
    let estimate = &summary["point_estimates"][0]["error"]["holdout"];
    assert_eq!(
        (&estimate["sinkage"]["runs"], &estimate["all"]["unpredicted"]),
        (&16.into(), &3.into())
    );
    for words in [
        "\ndeep: the model refuses it at 60 of 60 final draws (no_support: ",
        "the model refuses 1 of 17 held-out runs: deep at 60 of 60 final draws",
        "errors and coverage are over the other 16 held-out runs",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
}
