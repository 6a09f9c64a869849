//! The rig as a suspect: nothing is missing from the model, but the soil drifts, sensors drift, and preparations differ.

use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run, study};
use serde_json::Value;

/// The soil stiffens by 20 % and the zero of the pull moves by 2.4 sds, over runs made in the order of their slip.
fn drifting() -> Job {
    Job {
        experiment: include_str!("../data/drift-in-slip-order/experiment.toml").into(),
        runs: include_str!("../data/drift-in-slip-order/runs.csv").into(),
        job: include_str!("../data/drift-in-slip-order/job.toml").into(),
        others: Vec::new(),
    }
}

/// Six preparations that differ by 10 % in stiffness and 1 degree in friction.
fn uneven() -> Job {
    Job {
        experiment: include_str!("../data/uneven-preparations/experiment.toml").into(),
        runs: include_str!("../data/uneven-preparations/runs.csv").into(),
        job: include_str!("../data/uneven-preparations/job.toml").into(),
        others: Vec::new(),
    }
}

/// The job without some of the last columns of its runs.
fn without(job: Job, columns: &[&str]) -> Job {
    let mut lines = job.runs.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let kept = |line: &str| {
        let fields = header.iter().zip(line.split(','));
        let fields: Vec<&str> = fields
            .filter(|(c, _)| !columns.contains(c))
            .map(|(_, f)| f)
            .collect();
        fields.join(",") + "\n"
    };
    Job {
        runs: job.runs.lines().map(kept).collect(),
        ..job
    }
}

/// The text that `check` prints of a job.
fn checked(job: &Job) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(folder.path()).display().to_string();
    run(coordinator(["check", &path])).success()
}

/// The summary of a finished study.
fn summary(job: &Job) -> Value {
    study(job).1
}

/// The explanations with their probabilities.
fn effects(summary: &Value) -> Vec<(&str, f64)> {
    let effects = summary["discovery"]["effects"].as_array().expect("a list").iter();
    effects
        .map(|e| {
            let probability = e["probability"].as_f64().expect("a number");
            (e["name"].as_str().expect("a name"), probability)
        })
        .collect()
}

fn flags<'a>(summary: &'a Value, kind: &str) -> Vec<&'a str> {
    let flags = summary["flags"].as_array().expect("a list").iter();
    let own = flags.filter(|flag| flag["kind"] == kind);
    own.map(|flag| flag["text"].as_str().expect("a text")).collect()
}

#[test]
fn a_drift_is_blamed_where_the_order_of_the_runs_is_stated() {
    let told = summary(&drifting());
    let physical: f64 = effects(&told)
        .iter()
        .filter(|(name, _)| *name != "none" && !name.starts_with("drift_"))
        .map(|(_, p)| p)
        .sum();
    assert!(physical < 0.2, "{:?}", effects(&told));
    let words = "the runs were made in the order of their slip (rank correlation 1.00): no effect that changes with slip can be told from a drift";
    let [flag] = flags(&told, "order")[..] else {
        panic!("{:?}", told["flags"])
    };
    assert!(flag.starts_with(words), "{flag}");
    assert!(checked(&drifting()).contains(&format!("warning: {words}")));
    let untold = summary(&without(drifting(), &["order", "prepared"]));
    let physical = effects(&untold);
    assert!(physical.iter().all(|(name, _)| !name.starts_with("drift_")));
    assert!(flags(&untold, "order").is_empty());
}

#[test]
fn preparations_that_differ_are_no_missing_effect() {
    let told = summary(&uneven());
    let verdict = told["discovery"]["verdict"].as_str().expect("a verdict");
    assert!(
        ["nothing_detectable", "undecided"].contains(&verdict),
        "{verdict}"
    );
    for (name, probability) in effects(&told) {
        assert!(name == "none" || probability < 0.8, "{name} {probability}");
    }
    let parameters = &told["calibrations"][0]["parameters"];
    let stiffness = parameters["noise.preparation_scatter"]["mean"].as_f64();
    assert!(
        stiffness.is_some_and(|sd| (0.02..0.3).contains(&sd)),
        "{parameters}"
    );
    assert!(flags(&told, "chi2").is_empty(), "{:?}", told["flags"]);
}
