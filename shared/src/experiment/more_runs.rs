//! Further runs added to an experiment.

use std::collections::{BTreeMap, BTreeSet};

use super::{Experiment, settings, table};
use crate::file::{FileError, FileSet};

impl Experiment {
    /// Returns the files of an experiment with the rows of another `runs.csv` appended, and the resulting number of runs.
    ///
    /// Columns are matched by name; rows of a file without a column leave it blank. Comments of both files are dropped. A
    /// [`FileError`] names the line of a new row that is malformed or whose run is in the experiment already.
    pub fn with_runs(name: &str, files: &FileSet, csv: &str) -> Result<(FileSet, usize), FileError> {
        let before = Experiment::parse(name, files)?;
        let file = Experiment::runs_file(name, files)?;
        let fail = |e: csv::Error| FileError::whole(&file, e.to_string());
        let with = |text: String| {
            let mut all = files.clone();
            all.files.insert(file.clone(), text);
            all
        };
        // the new file is parsed alone first, so that messages name its lines
        Experiment::parse(name, &with(csv.to_owned()))?;
        let (mut header, mut rows) = records(&file, files.named(name, &file)?)?;
        let (new_header, new_rows) = records(&file, csv)?;
        let run_at = new_header.iter().position(|column| column == "run");
        let names: BTreeSet<&str> = before.runs.iter().map(|run| run.name.as_str()).collect();
        for (line, row) in &new_rows {
            if let Some(run) = run_at.and_then(|at| row.get(at))
                && names.contains(run.as_str())
            {
                return Err(FileError::at(
                    &file,
                    *line,
                    format!("run \"{run}\" is in the study already"),
                ));
            }
        }
        for column in &new_header {
            if !header.contains(column) {
                header.push(column.clone());
            }
        }
        for (line, row) in new_rows {
            let mut fields: BTreeMap<&str, String> = BTreeMap::new();
            fields.extend(new_header.iter().map(String::as_str).zip(row));
            let row = header
                .iter()
                .map(|column| fields.remove(column.as_str()).unwrap_or_default());
            rows.push((line, row.collect()));
        }
        let enlarged = with(written(&header, rows).map_err(fail)?);
        let runs = Experiment::parse(name, &enlarged)?.runs.len();
        Ok((enlarged, runs))
    }

    /// Returns the name of the file with the runs of an experiment.
    ///
    /// # Errors
    /// [`FileError`] if the experiment has no runs.
    pub fn runs_file(name: &str, files: &FileSet) -> Result<String, FileError> {
        let missing = "runs = \"runs.csv\" is missing: the experiment has no runs to append to";
        let file = settings::parse(name, &files.toml)?.runs;
        file.ok_or_else(|| FileError::whole(name, missing))
    }
}

/// The header of a CSV file, and its rows with their lines.
pub(super) type Records = (Vec<String>, Vec<(usize, Vec<String>)>);

pub(super) fn records(file: &str, text: &str) -> Result<Records, FileError> {
    let mut reader = table::reader(text);
    let fail = |e: csv::Error| FileError::whole(file, e.to_string());
    let fields = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
    let header = fields(reader.headers().map_err(fail)?);
    let rows = reader
        .records()
        .map(|record| record.map(|record| (table::line_of(text, &record), fields(&record))))
        .collect::<Result<_, _>>()
        .map_err(fail)?;
    Ok((header, rows))
}

/// Writes the text of a CSV file; short rows are filled with blanks.
pub(super) fn written(header: &[String], rows: Vec<(usize, Vec<String>)>) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for (_, mut row) in rows {
        row.resize(header.len(), String::new());
        writer.write_record(row)?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOML: &str = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.sand]\n[noise]\ndrawbar_pull_n = 1.0\ntorque_n_m = 0.1\n";
    const RUNS: &str = "# first day\nrun,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n\"one, two\",a,sand,0.2,25,0.01,0.5,fit\n";
    const MORE: &str = "# second day\nuse,session,zero,operator,run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,torque_n_m\n# sunny\nholdout,day 2,tare 3,Ada,three,a,sand,0.4,25,0.02,0.7\n";

    const PLATES: &str = "test,plate_radius_m,sinkage_m,pressure_pa\na,0.03,0.01,8000\n";

    fn files(runs: &str) -> FileSet {
        FileSet {
            toml: TOML.into(),
            files: BTreeMap::from([("runs.csv".into(), runs.into())]),
        }
    }

    #[test]
    fn rows_join_by_the_names_of_their_columns() {
        let (enlarged, runs) = Experiment::with_runs("experiment.toml", &files(RUNS), MORE).unwrap();
        assert_eq!((runs, &enlarged.toml), (2, &files(RUNS).toml));
        let after = Experiment::parse("experiment.toml", &enlarged).unwrap();
        let before = Experiment::parse("experiment.toml", &files(RUNS)).unwrap();
        let alone = Experiment::parse("experiment.toml", &files(MORE)).unwrap();
        assert_eq!(after.runs, [before.runs, alone.runs].concat());
    }

    #[test]
    fn rows_that_cannot_be_added_are_named_by_line() {
        for (old, new, message) in [
            (
                "three",
                "\"one, two\"",
                "line 4: run \"one, two\" is in the study already",
            ),
            ("0.4,25", "1.4,25", "line 4: slip 1.4 must be at most 1"),
            ("torque_n_m", "torque", "line 2: unknown column \"torque\""),
            ("0.02,0.7", "0.02", "line 4: 10 fields where the header has 11"),
        ] {
            let new_rows = MORE.replace(old, new);
            let error = Experiment::with_runs("experiment.toml", &files(RUNS), &new_rows).unwrap_err();
            assert!(
                error.to_string().starts_with(&format!("runs.csv {message}")),
                "{error}"
            );
        }
        let plates = FileSet {
            toml: TOML.replace("runs = \"runs.csv\"", "plates = \"plates.csv\""),
            files: [("plates.csv".into(), PLATES.into())].into(),
        };
        let error = Experiment::with_runs("experiment.toml", &plates, MORE).unwrap_err();
        assert!(error.to_string().contains("no runs to append to"), "{error}");
    }
}
