//! An experiment with some of its fitted runs held out.

use super::more_runs::{records, written};
use super::{Experiment, RunUse, settings};
use crate::file::{FileError, FileSet};

impl Experiment {
    /// Returns the files of an experiment with these fitted runs held out: `use = holdout` in their rows of `runs.csv`. All
    /// columns are kept; comments are dropped.
    ///
    /// A [`FileError`] names a run that is unknown, named twice or already held out; one fitted run must remain.
    pub fn with_held_out(name: &str, files: &FileSet, runs: &[String]) -> Result<FileSet, FileError> {
        let before = Experiment::parse(name, files)?;
        let file = settings::parse(name, &files.toml)?.runs;
        let fail = |message: String| FileError::whole(file.as_deref().unwrap_or(name), message);
        let Some(file) = &file else {
            return Err(fail(
                "runs = \"runs.csv\" is missing: the experiment has no runs".into(),
            ));
        };
        if runs.is_empty() {
            return Err(fail("no run is named: name at least one fitted run".into()));
        }
        for (i, run) in runs.iter().enumerate() {
            match before.runs.iter().find(|candidate| candidate.name == *run) {
                None => return Err(fail(format!("there is no run \"{run}\""))),
                Some(candidate) if candidate.usage != RunUse::Fit => {
                    return Err(fail(format!("run \"{run}\" is held out already")));
                }
                Some(_) if runs[..i].contains(run) => {
                    return Err(fail(format!("run \"{run}\" is named twice")));
                }
                Some(_) => {}
            }
        }
        let fitted = before.runs.iter().filter(|run| run.usage == RunUse::Fit).count();
        if fitted == runs.len() {
            let message = format!("all {fitted} fitted runs are left out: leave at least one to fit");
            return Err(fail(message));
        }
        let (mut header, mut rows) = records(file, files.named(name, file)?)?;
        let place = |header: &[String], column: &str| header.iter().position(|candidate| candidate == column);
        let usage = place(&header, "use").unwrap_or_else(|| {
            header.push("use".into());
            header.len() - 1
        });
        let run = place(&header, "run").expect("an experiment that parses has the column run");
        for (_, row) in &mut rows {
            row.resize(header.len(), String::new());
            if runs.contains(&row[run]) {
                row[usage] = RunUse::Holdout.name().into();
            }
        }
        let mut edited = files.clone();
        let text = written(&header, rows).map_err(|e| fail(e.to_string()))?;
        edited.files.insert(file.clone(), text);
        Ok(edited)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    const TOML: &str = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.sand]\n[noise]\ndrawbar_pull_n = 1.0\n";
    const HEADER: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n";

    fn files(runs: &str) -> FileSet {
        FileSet {
            toml: TOML.into(),
            files: BTreeMap::from([("runs.csv".into(), runs.into())]),
        }
    }

    fn held_out(runs: &str, names: &[&str]) -> Result<String, String> {
        let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
        let edited = Experiment::with_held_out("experiment.toml", &files(runs), &names);
        edited
            .map(|files| files.files["runs.csv"].clone())
            .map_err(|e| e.to_string())
    }

    #[test]
    fn the_rows_of_these_runs_are_held_out_and_nothing_else_changes() {
        let runs = format!(
            "{HEADER},use\n# a comment\na,a,sand,0.2,25,0.01,0.5,fit\n\"b, c\",a,sand,0.4,25,0.01,0.7,fit\n"
        );
        let expected =
            format!("{HEADER},use\na,a,sand,0.2,25,0.01,0.5,fit\n\"b, c\",a,sand,0.4,25,0.01,0.7,holdout\n");
        assert_eq!(held_out(&runs, &["b, c"]).unwrap(), expected);
        let runs = format!("{HEADER}\na,a,sand,0.2,25,0.01,0.5\nb,a,sand,0.4,25,0.01,0.7\n");
        let expected = format!("{HEADER},use\na,a,sand,0.2,25,0.01,0.5,holdout\nb,a,sand,0.4,25,0.01,0.7,\n");
        assert_eq!(held_out(&runs, &["a"]).unwrap(), expected);
    }

    #[test]
    fn runs_that_cannot_be_held_out_are_refused_with_a_reason() {
        let runs = format!("{HEADER},use\na,a,sand,0.2,25,0.01,0.5,fit\nb,a,sand,0.4,25,0.01,0.7,holdout\n");
        for (names, message) in [
            (&[][..], "runs.csv: no run is named: name at least one fitted run"),
            (&["x"], "runs.csv: there is no run \"x\""),
            (&["b"], "runs.csv: run \"b\" is held out already"),
            (&["a", "a"], "runs.csv: run \"a\" is named twice"),
            (
                &["a"],
                "runs.csv: all 1 fitted runs are left out: leave at least one to fit",
            ),
        ] {
            assert_eq!(held_out(&runs, names).unwrap_err(), message);
        }
    }
}
