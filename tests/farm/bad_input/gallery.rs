//! Lists of mistakes of users: changes of a good job, and the whole message of `check` and `run`.
//!
//! The changes of a mistake stand on a line each, then its message, indented. `FILE: OLD => NEW` replaces the one occurrence of a passage,
//! `=>>` every occurrence, `\n` ends a line of a passage, `\t` is a tab; `FILE: COLUMN times FACTOR` changes the unit of a column; `FILE: as FORM` sends
//! the file in another form.

use farm_tests::job::{GAIN, Job};

use super::{PLATES, SHEAR, refusal_in};

/// Returns the mistakes of a list: changes and message of each.
fn mistakes(list: &str) -> Vec<(Vec<&str>, &str)> {
    let (mut mistakes, mut changes) = (Vec::new(), Vec::new());
    for line in list
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
    {
        match line.strip_prefix("  ") {
            Some(message) => mistakes.push((std::mem::take(&mut changes), message)),
            None => changes.push(line),
        }
    }
    assert!(changes.is_empty(), "without a message: {changes:?}");
    mistakes
}

/// Returns the good job, with the effect file and the readings of a bevameter that are changed.
fn good(changes: &[&str]) -> Job {
    let is_changed = |file: &str| changes.iter().any(|change| change.starts_with(file));
    let (kind, runs) = ("kind = \"quasi_static\"", "runs = \"runs.csv\"");
    let mut job = Job::small();
    for (file, key, text) in [("plates.csv", "plates", PLATES), ("shear.csv", "shear", SHEAR)] {
        if is_changed(file) {
            let both = format!("{key} = \"{file}\"\n{runs}");
            job = job.in_experiment(runs, &both).beside(file, text);
        }
    }
    if is_changed("gain.toml") {
        let both = format!("{kind}\neffect_files = [\"gain.toml\"]");
        job = job.in_job(kind, &both).beside("gain.toml", GAIN);
    }
    job
}

/// Returns the content of a file after a change.
fn changed(text: &str, change: &str) -> Vec<u8> {
    if let Some(form) = change.strip_prefix("as ") {
        return shaped(text, form);
    }
    if let Some((column, factor)) = change.split_once(" times ") {
        return scaled(text, column, factor.parse().expect("a factor")).into_bytes();
    }
    let (old, new) = change.split_once(" =>").expect("a change");
    let (new, is_every) = new.strip_prefix('>').map_or((new, false), |new| (new, true));
    let count = text.matches(old).count();
    assert!(
        count == 1 || is_every && count > 1,
        "{old:?} {count} times in\n{text}"
    );
    text.replace(old, new.strip_prefix(' ').unwrap_or(new))
        .into_bytes()
}

/// Returns a file in another form.
fn shaped(text: &str, form: &str) -> Vec<u8> {
    let rows = || text.lines().filter(|line| !line.starts_with('#'));
    let first = |count: usize| {
        rows()
            .take(count)
            .map(|line| format!("{line}\n"))
            .collect::<String>()
    };
    match form {
        "german" => {
            let german = |line: &str| format!("{}\n", line.replace(',', ";").replace('.', ","));
            rows().map(german).collect::<String>().into_bytes()
        }
        "xlsx" => b"PK\x03\x04\x14\x00\x06\x00\x08\x00\xff\xfe".to_vec(),
        "mat" => b"MATLAB 5.0 MAT-file, Platform: GLNXA64\x00\x01IM\x0f\x00\x9c\xff".to_vec(),
        "utf-16" => format!("\u{feff}{text}")
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect(),
        "latin-1" => {
            let text = text.replace("# Synthetic", "# Schlämmsand");
            let bytes = text
                .chars()
                .map(|c| u8::try_from(c).expect("a character of Latin-1"));
            bytes.collect()
        }
        "header" => first(1).into_bytes(),
        "one run" => first(2).into_bytes(),
        "empty" => Vec::new(),
        "gain.toml" => GAIN.into(),
        other => panic!("{other}"),
    }
}

/// Returns a CSV file with every number of a column in another unit.
pub(in super::super) fn scaled(good: &str, column: &str, times: f64) -> String {
    let mut place = None;
    let mut lines = String::new();
    for line in good.lines() {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        match place {
            _ if line.starts_with('#') => {}
            None => place = fields.iter().position(|field| field == column),
            Some(place) => {
                fields[place] = (fields[place].parse::<f64>().expect("a number") * times).to_string()
            }
        }
        lines += &(fields.join(",") + "\n");
    }
    lines
}

/// Returns the refusal of the good job with changes.
fn refusal_of(changes: &[&str]) -> String {
    let temporary = tempfile::tempdir().expect("a folder");
    let folder = temporary.path();
    good(changes).write(folder);
    for change in changes {
        let (file, change) = change.split_once(": ").expect("a file");
        let path = folder.join(file);
        // A second effect file is made by its form alone.
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let change = change.replace("\\n", "\n").replace("\\t", "\t");
        std::fs::write(path, changed(&text, &change)).expect("a file of the job");
    }
    refusal_in(&folder.join("job.toml"), folder)
}

/// Asserts that every mistake of a list is refused with its message.
#[track_caller]
fn all_are_refused(list: &str, count: usize) {
    let mistakes = mistakes(list);
    assert_eq!(mistakes.len(), count);
    let found = mistakes
        .iter()
        .map(|(changes, message)| (changes, message, refusal_of(changes)));
    let wrong = found.filter(|(_, message, found)| found != *message);
    let wrong: Vec<String> = wrong
        .map(|(changes, message, found)| format!("{changes:#?}:\n  {found}\n  {message}"))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_mistake_of_a_user_is_silent() {
    all_are_refused(include_str!("../../data/mistakes/users.txt"), 70);
}

#[test]
fn wrong_jobs_are_refused() {
    all_are_refused(include_str!("../../data/mistakes/jobs.txt"), 48);
}

#[test]
fn wrong_effects_are_refused() {
    all_are_refused(include_str!("../../data/mistakes/effects.txt"), 24);
}

#[test]
fn wrong_experiments_are_refused() {
    all_are_refused(include_str!("../../data/mistakes/experiments.txt"), 29);
}

#[test]
fn wrong_readings_are_refused() {
    all_are_refused(include_str!("../../data/mistakes/readings.txt"), 12);
}
