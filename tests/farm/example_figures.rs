//! The figures that the examples' READMEs print are those that the program gives.

use std::collections::BTreeSet;

use farm_tests::json::items;
use farm_tests::programs::{coordinator, run};
use farm_tests::workspace::{files, root, text};
use serde::Deserialize;
use serde_json::Value;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    /// Jobs whose figures are not compared.
    not_held: BTreeSet<String>,
    example: Vec<Example>,
}

/// A run and the figures that a README states for it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Example {
    readme: String,
    job: String,
    /// Further arguments of `coordinator run`.
    #[serde(default)]
    arguments: Vec<String>,
    /// Whether the run takes more than a minute.
    #[serde(default)]
    is_slow: bool,
    /// The verdicts of all searches, in their order.
    verdicts: Option<Vec<String>>,
    /// A passage, then the places of the numbers that follow it.
    figures: Vec<Vec<String>>,
}

fn list() -> List {
    toml::from_str(include_str!("../data/example-figures/figures.toml")).expect("a list of figures")
}

/// A number as it is printed.
#[derive(Debug, PartialEq)]
struct Printed {
    value: f64,
    /// Half a unit of its last digit.
    rounding: f64,
    /// `<` or `>` before it.
    relation: Option<char>,
}

impl Printed {
    fn holds(&self, value: f64) -> bool {
        match self.relation {
            Some('<') => value < self.value,
            Some('>') => value > self.value,
            _ => (value - self.value).abs() <= self.rounding * (1.0 + 1e-9),
        }
    }
}

/// Returns the numbers of a text, those within names left out.
fn numbers(text: &str) -> Vec<Printed> {
    let mut found = Vec::new();
    let (mut rest, mut before) = (text, ' ');
    while let Some(first) = rest.chars().next() {
        let length = rest
            .find(|c: char| !c.is_ascii_alphanumeric() && !matches!(c, '.' | ',' | '_'))
            .unwrap_or(rest.len());
        let token = rest[..length].trim_end_matches(['.', ',']);
        if let Some(printed) = number(token, text[..text.len() - rest.len()].trim_end(), before) {
            found.push(printed);
        }
        let step = length.max(first.len_utf8());
        before = rest[..step].chars().next_back().unwrap_or(' ');
        rest = &rest[step..];
    }
    found
}

/// Returns a token as a number.
///
/// # Arguments
/// - `ahead`: the text before it, without the last blanks. `before`: the character before it.
fn number(token: &str, ahead: &str, before: char) -> Option<Printed> {
    if !token.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let size: f64 = token.replace(',', "").parse().ok()?;
    let decimals = token.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let sign = ahead
        .strip_suffix(['-', '\u{2212}'])
        .filter(|_| matches!(before, '-' | '\u{2212}'));
    let is_negative = sign.is_some_and(|text| !text.ends_with(char::is_alphanumeric));
    Some(Printed {
        value: if is_negative { -size } else { size },
        rounding: 0.5 / 10_f64.powi(i32::try_from(decimals).ok()?),
        relation: ahead.chars().next_back().filter(|c| matches!(c, '<' | '>')),
    })
}

/// Returns the value at a place of a summary.
fn value(summary: &Value, place: &str) -> Option<f64> {
    let (pointer, factor) = match place.split_once(" * ") {
        Some((pointer, factor)) => (pointer, factor.parse().ok()?),
        None => (place, 1.0),
    };
    let step = |found: &'_ Value, part: &str| -> Option<Value> {
        match (found, part.split_once('=')) {
            (Value::Array(list), Some((key, name))) => list.iter().find(|item| item[key] == name).cloned(),
            (Value::Array(list), None) => list.get(part.parse::<usize>().ok()?).cloned(),
            _ => found.get(part).cloned(),
        }
    };
    let mut parts = pointer.trim_start_matches('/').split('/');
    let found = parts.try_fold(summary.clone(), |found, part| step(&found, part))?;
    match found {
        Value::Array(list) => Some(list.len() as f64 * factor),
        found => Some(found.as_f64()? * factor),
    }
}

/// Returns the differences between a README and a summary.
fn contradictions(example: &Example, readme: &str, summary: &Value) -> Vec<String> {
    let readme = readme.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut found = Vec::new();
    for figure in &example.figures {
        let (passage, places) = figure.split_first().expect("a passage");
        let Some((_, after)) = readme.split_once(passage.as_str()) else {
            found.push(format!("{passage}: not in the README"));
            continue;
        };
        if after.contains(passage.as_str()) {
            found.push(format!("{passage}: more than once in the README"));
        }
        let mut printed = numbers(after).into_iter();
        for place in places {
            let printed = printed.next().expect("a number");
            if place.is_empty() {
                continue;
            }
            match value(summary, place) {
                Some(value) if printed.holds(value) => {}
                value => found.push(format!("{passage}: {printed:?}, the program {value:?} ({place})")),
            }
        }
    }
    if let Some(expected) = &example.verdicts {
        let rounds = items(&summary["discovery"]["rounds"]);
        let verdicts: Vec<&str> = rounds.filter_map(|round| round["verdict"].as_str()).collect();
        if verdicts != *expected {
            found.push(format!("verdicts {expected:?}, the program {verdicts:?}"));
        }
    }
    found
}

/// Runs the quick jobs of a README, and compares their results with its figures.
#[track_caller]
fn hold(readme: &str) {
    hold_those(readme, false);
}

/// Runs the slow or the quick jobs of a README.
#[track_caller]
fn hold_those(readme: &str, slow: bool) {
    let examples = root().join("examples");
    let text = text(&examples.join(readme));
    let mut wrong = Vec::new();
    let list = list();
    let examples_of_readme = list.example.iter().filter(|example| example.readme == readme);
    for example in examples_of_readme.filter(|example| example.is_slow == slow) {
        let out = tempfile::tempdir().expect("a folder");
        let arguments = example
            .arguments
            .iter()
            .map(|argument| match argument.ends_with(".toml") {
                true => examples.join(argument).display().to_string(),
                false => argument.clone(),
            });
        let mut command = coordinator(["run"]);
        command.arg(examples.join(&example.job)).args(arguments);
        run({
            command.arg("--out").arg(out.path());
            command
        })
        .success();
        let summary = std::fs::read_to_string(out.path().join("summary.json")).expect("a summary");
        let summary = serde_json::from_str(&summary).expect("JSON");
        let found = contradictions(example, &text, &summary);
        wrong.extend(found.into_iter().map(|found| format!("{} {found}", example.job)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn hidden_effect_gives_the_figures_of_its_readme() {
    hold("hidden-effect/README.md");
}

#[test]
fn import_german_gives_what_its_readme_says() {
    hold("import-german/README.md");
}

#[test]
fn paper_gives_the_figures_of_its_readme() {
    hold("paper/README.md");
}

#[test]
fn which_model_gives_the_figures_of_its_readme() {
    hold("which-model/README.md");
}

#[test]
fn other_rigs_give_the_figures_of_their_readme() {
    hold("other-rigs/README.md");
}

#[test]
fn cmu_sand_gives_the_figures_of_its_readme() {
    hold("cmu-sand/README.md");
}

#[test]
#[ignore = "its two jobs take four minutes on two cores"]
fn cmu_sand_gives_the_figures_of_its_slow_runs() {
    hold_those("cmu-sand/README.md", true);
}

#[test]
fn every_job_of_the_examples_is_held_or_listed_as_not_held() {
    let list = list();
    let folder = root().join("examples");
    let is_job = |text: &str| text.starts_with("experiment = ") || text.contains("\nexperiment = ");
    let jobs: BTreeSet<String> = files("examples", ".toml")
        .into_iter()
        .filter(|path| is_job(&text(path)))
        .map(|path| {
            path.strip_prefix(&folder)
                .expect("an example")
                .display()
                .to_string()
        })
        .collect();
    let held = list.example.iter().map(|example| example.job.clone());
    let listed: BTreeSet<String> = list.not_held.iter().cloned().chain(held).collect();
    assert_eq!(jobs, listed);
}

#[test]
fn a_figure_that_the_program_does_not_give_is_told() {
    assert_eq!(
        numbers("| base | −1,347.66 ± 0.01 | P > 0.9, log10_p_ref 5–95 %: 1.5."),
        [
            (-1347.66, 0.005, None),
            (0.01, 0.005, None),
            (0.9, 0.05, Some('>')),
            (5.0, 0.5, None),
            (95.0, 0.5, None),
            (1.5, 0.05, None)
        ]
        .map(|(value, rounding, relation)| Printed {
            value,
            rounding,
            relation
        })
    );
    let example = Example {
        readme: String::new(),
        job: String::new(),
        arguments: Vec::new(),
        is_slow: false,
        verdicts: Some(vec!["named".into()]),
        figures: vec![vec![
            "| base |".into(),
            "/a/name=x/b * 1000".into(),
            String::new(),
            "/a".into(),
        ]],
    };
    let summary = |b: f64| serde_json::json!({"a": [{"name": "y"}, {"name": "x", "b": b}], "discovery": {"rounds": [{"verdict": "named"}]}});
    let readme = "text\n| base |\n0.33 of 7 in 2";
    assert_eq!(
        contradictions(&example, readme, &summary(3.3e-4)),
        Vec::<String>::new()
    );
    assert_eq!(contradictions(&example, readme, &summary(3.36e-4)).len(), 1);
    assert_eq!(contradictions(&example, "| base 0.33", &summary(3.3e-4)).len(), 1);
}
