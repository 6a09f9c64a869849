//! Rigs with a drift, uneven preparations or sessions that differ, where no effect is missing from the model.

use farm_tests::job::Job;
use farm_tests::json::{float, items, word};
use farm_tests::programs::{coordinator, run, study};
use serde_json::Value;

/// The soil stiffens by 20 % and the zero of the pull moves by 2.4 sds, over runs made in the order of their slip.
fn drifting() -> Job {
    Job::data("drift-in-slip-order")
}

/// Returns the job without some of the last columns of its runs.
fn without(job: Job, columns: &[&str]) -> Job {
    let header: Vec<&str> = job.runs.lines().next().expect("a header").split(',').collect();
    let kept = |line: &str| {
        let fields = header.iter().zip(line.split(','));
        let fields = fields.filter(|(column, _)| !columns.contains(column));
        fields.map(|(_, field)| field).collect::<Vec<_>>().join(",") + "\n"
    };
    Job {
        runs: job.runs.lines().map(kept).collect(),
        ..job
    }
}

/// Returns the text that `check` prints of a job.
fn checked(job: &Job) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(folder.path()).display().to_string();
    run(coordinator(["check", &path])).success()
}

/// Returns the summary of a finished study.
fn summary(job: &Job) -> Value {
    study(job).1
}

/// Returns the explanations with their probabilities.
fn effects(summary: &Value) -> Vec<(&str, f64)> {
    let effects = items(&summary["discovery"]["effects"]);
    effects
        .map(|effect| (word(&effect["name"]), float(&effect["probability"])))
        .collect()
}

fn flags<'a>(summary: &'a Value, kind: &str) -> Vec<&'a str> {
    let flags = items(&summary["flags"]);
    let flags = flags.filter(|flag| flag["kind"] == kind);
    flags.map(|flag| word(&flag["text"])).collect()
}

#[test]
fn a_drift_is_blamed_where_the_order_of_the_runs_is_stated() {
    let stated = summary(&drifting());
    let found = effects(&stated);
    let is_of_library =
        |name: &str| name != "none" && name != "not_in_library" && !name.starts_with("drift_");
    let of_library = found.iter().filter(|(name, _)| is_of_library(name));
    let of_library: f64 = of_library.map(|(_, probability)| probability).sum();
    assert!(of_library < 0.01, "{found:?}");
    // A law that depends on slip does the same as the drift of runs in the order of their slip.
    let drift: f64 = found
        .iter()
        .filter(|(name, _)| name.starts_with("drift_"))
        .map(|(_, probability)| probability)
        .sum();
    assert!(drift > 0.5 && found[0].0.starts_with("drift_"), "{found:?}");
    assert_eq!(stated["discovery"]["verdict"], "undecided");
    let words = "the runs were made in the order of their slip (rank correlation 1.00): no effect that changes with slip can be told from a drift";
    let [flag] = flags(&stated, "order")[..] else {
        panic!("{:?}", stated["flags"])
    };
    assert!(flag.starts_with(words), "{flag}");
    assert!(checked(&drifting()).contains(&format!("warning: {words}")));
    let unstated = summary(&without(drifting(), &["order", "prepared"]));
    assert!(
        effects(&unstated)
            .iter()
            .all(|(name, _)| !name.starts_with("drift_"))
    );
    // What is claimed then is a law of the slip, with the doubt beside it.
    assert_eq!(unstated["discovery"]["verdict"], "not_in_library");
    let [flag] = flags(&unstated, "order")[..] else {
        panic!("{:?}", unstated["flags"])
    };
    let words = "the rows of the runs follow their slip, and no run states its order";
    assert!(flag.starts_with(words), "{flag}");
}

#[test]
fn preparations_that_differ_are_no_missing_effect() {
    // Six preparations differ by 10 % in stiffness and 1 degree in friction.
    let summary = summary(&Job::data("uneven-preparations"));
    let verdict = word(&summary["discovery"]["verdict"]);
    assert!(
        ["nothing_detectable", "undecided"].contains(&verdict),
        "{verdict}"
    );
    for (name, probability) in effects(&summary) {
        assert!(name == "none" || probability < 0.8, "{name} {probability}");
    }
    let parameters = &summary["calibrations"][0]["parameters"];
    let stiffness = parameters["noise.preparation_scatter"]["mean"].as_f64();
    assert!(
        stiffness.is_some_and(|sd| (0.02..0.3).contains(&sd)),
        "{parameters}"
    );
    assert!(flags(&summary, "chi2").is_empty(), "{:?}", summary["flags"]);
}

/// Offsets of the drawbar pull in four sessions [N]; its noise is 1.2 N.
const OFFSETS_N: [f64; 4] = [3.0, -2.0, -3.0, 2.0];

/// Returns a job whose runs were made in four sessions, each with conditions of all kinds, with an offset of the drawbar pull in each.
fn of_sessions(job: Job) -> Job {
    let mut rows = job.runs.lines().filter(|line| !line.starts_with('#'));
    let header = rows.next().expect("a header");
    let pull = header.split(',').position(|column| column == "drawbar_pull_n");
    let pull = pull.expect("a column of the drawbar pull");
    let row = |(i, line): (usize, &str)| {
        let session = (i + i / 4) % OFFSETS_N.len();
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        let measured: f64 = fields[pull].parse().expect("a number");
        fields[pull] = (measured + OFFSETS_N[session]).to_string();
        format!("{},day {session}\n", fields.join(","))
    };
    let rows: String = rows.enumerate().map(row).collect();
    Job {
        runs: format!("{header},session\n{rows}"),
        job: format!("{}\n[discovery]\napply = \"auto\"\n", job.job),
        ..job
    }
}

#[test]
fn sessions_with_other_zeros_are_no_missing_effect() {
    let job = of_sessions(Job::data("nothing-hidden"));
    let unstated = summary(&without(job.clone(), &["session"]));
    // Without the column the offsets pass for physics.
    assert_ne!(word(&unstated["discovery"]["verdict"]), "nothing_detectable");
    let stated = summary(&job);
    assert_eq!(word(&stated["discovery"]["verdict"]), "nothing_detectable");
    let errors: Vec<&Value> = items(&stated["discovery"]["rounds"][0]["rig"]).collect();
    let (pull, others): (Vec<&Value>, Vec<&Value>) = errors
        .into_iter()
        .partition(|error| error["name"] == "session_drawbar_pull_n");
    let [pull] = pull[..] else { panic!("{pull:?}") };
    assert!(float(&pull["probability"]) > 0.99, "{pull}");
    for offset in items(&pull["offsets"]) {
        let session = word(&offset["id"]).trim_start_matches("day ");
        let expected = OFFSETS_N[session.parse::<usize>().expect("a number")];
        let [mean, sd] = ["mean", "sd"].map(|key| float(&offset[key]));
        assert!((mean - expected).abs() < 2.5 * sd && sd < 1.0, "{offset}");
    }
    assert!(!others.is_empty());
    for error in others {
        assert!(float(&error["probability"]) < 0.8, "{error}");
    }
}

#[test]
fn an_effect_is_named_beside_sessions_with_other_zeros() {
    let stated = summary(&of_sessions(Job::data("shear-mobilisation")));
    assert_eq!(word(&stated["discovery"]["verdict"]), "named");
    assert_eq!(
        stated["discovery"]["chosen"],
        serde_json::json!(["janosi_hanamoto"])
    );
}
