//! Mistakes of a whole table, made in examples and in synthetic experiments, and the question that must be asked about each.
//!
//! A line of `tables.txt` has a job, the change of its experiment, and the question's name or a passage of the refusal: `JOB: CHANGE =>
//! QUESTION`. `COLUMN times NUMBER`, `COLUMN plus NUMBER` and `COLUMN swaps COLUMN` change the runs; `WHEEL for WHEEL` exchanges the names of
//! two wheels in them; `OLD becomes NEW` replaces every occurrence of a passage in the experiment's file.

use farm_tests::workspace;
use job::{Spec, questions};
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::text_file::{read_beside, read_text, sibling};

/// Experiments of `tests/data` with hidden effects, drifts and uneven soil, in which nothing is mistaken.
const RIGHT: [&str; 11] = [
    "drift-in-slip-order",
    "elastic-soil",
    "flexible-rim",
    "law-of-two-variables",
    "nothing-hidden",
    "one-of-a-class",
    "outside-the-catalogue",
    "shear-mobilisation",
    "store-19",
    "undetectable",
    "uneven-preparations",
];

/// Returns the names of the questions about a job after a change of its experiment, or the refusal.
fn raised(job: &str, change: &str) -> Result<Vec<String>, String> {
    let path = workspace::root().join(job);
    let toml = read_text(&path).expect("a job");
    let parsed = job::Job::parse("job.toml", &toml).expect("a right job");
    let files = read_beside(&path, &parsed.named_files()).expect("the files of the job");
    let experiment = sibling(&path, &parsed.experiment.expect("an experiment"));
    let mut experiment = Experiment::read_files(&experiment).expect("its files");
    if let Some((old, new)) = change.split_once(" becomes ") {
        assert!(experiment.toml.contains(old), "{job}: {old}");
        experiment.toml = experiment.toml.replace(old, new);
    } else if !change.is_empty() {
        let runs = experiment
            .files
            .values_mut()
            .find(|text| text.contains("wheel_load_n"));
        let runs = runs.expect("a table of runs");
        *runs = changed(runs, change);
    }
    let job = FileSet { toml, files };
    let spec = Spec::new("job.toml", &job, "experiment.toml", &experiment).map_err(|e| e.to_string())?;
    Ok(questions(&spec)
        .into_iter()
        .map(|question| question.name)
        .collect())
}

/// Returns a table after a change of its columns.
fn changed(runs: &str, change: &str) -> String {
    let words: Vec<&str> = change.split(' ').collect();
    let [what, how, other] = words[..] else {
        panic!("{change}")
    };
    let mut rows = runs
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').map(str::to_owned).collect::<Vec<String>>());
    let header = rows.next().expect("a header");
    let place = |column: &str| header.iter().position(|name| name == column).expect(change);
    let mut table = header.join(",") + "\n";
    for mut row in rows {
        match how {
            "swaps" => row.swap(place(what), place(other)),
            "for" => {
                let wheel = &mut row[place("wheel")];
                *wheel = if wheel == what { other } else { what }.to_owned();
            }
            _ => {
                let field = &mut row[place(what)];
                let number: f64 = other.parse().expect(change);
                if let Ok(value) = field.parse::<f64>() {
                    let value = if how == "plus" {
                        value + number
                    } else {
                        value * number
                    };
                    *field = value.to_string();
                }
            }
        }
        table += &(row.join(",") + "\n");
    }
    table
}

/// Returns job, change and question of each mistake in `tables.txt`.
fn mistakes() -> Vec<(&'static str, &'static str, &'static str)> {
    let lines = include_str!("../data/mistakes/tables.txt").lines();
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with('#'));
    let split = |line: &'static str| {
        let (place, question) = line.split_once(" => ").expect(line);
        let (job, change) = place.split_once(": ").expect(line);
        (job, change, question)
    };
    lines.map(split).collect()
}

#[test]
fn every_mistake_of_a_table_is_asked_about() {
    let mistakes = mistakes();
    assert_eq!(mistakes.len(), 34);
    let mut silent = Vec::new();
    for (job, change, expected) in mistakes {
        let found = raised(job, change);
        let is_found = match &found {
            Ok(names) => names.iter().any(|name| name == expected),
            Err(refusal) => refusal.contains(expected),
        };
        if !is_found {
            silent.push(format!("{job}: {change}: {expected}: {found:?}"));
        }
    }
    assert!(silent.is_empty(), "{}", silent.join("\n"));
}

#[test]
fn a_right_table_raises_no_question() {
    for name in RIGHT {
        let names = raised(&format!("tests/data/{name}/job.toml"), "").unwrap();
        assert_eq!(names, [""; 0], "{name}");
    }
}
