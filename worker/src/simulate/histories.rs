//! Time histories of the wheel's runs, one file for each.

use std::path::{Path, PathBuf};

use scm::spatial::History;
use shared::experiment::Experiment;
use shared::file::FileError;
use shared::model::ModelVariant;
use signal::INTERVAL_S;

use super::error::SimulateError;
use crate::model::at_10_hz;

/// Columns of a history file: time at the end of an interval, and means over the interval.
const COLUMNS: [&str; 6] = [
    "t_s",
    "drawbar_pull_n",
    "torque_n_m",
    "sinkage_m",
    "lateral_force_n",
    "wheel_load_n",
];

/// Returns the file of each run in a folder, at 10 Hz, unfiltered, with transients.
pub(super) fn histories(
    experiment: &Experiment,
    variant: &ModelVariant,
    rolled: &[History],
    folder: &Path,
) -> Result<Vec<(PathBuf, Vec<u8>)>, SimulateError> {
    if rolled.is_empty() {
        let message = format!(
            "--histories: {} has only a steady state; use kind = \"scm\"",
            variant.kind.name()
        );
        return Err(FileError::whole(&folder.display().to_string(), message).into());
    }
    let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    for (run, history) in experiment.runs.iter().zip(rolled) {
        let path = folder.join(file_name(&run.name));
        if files.iter().any(|(other, _)| *other == path) {
            let message = format!("two runs would both be written to {}", path.display());
            return Err(FileError::whole(&folder.display().to_string(), message).into());
        }
        files.push((path, table(history)?));
    }
    Ok(files)
}

/// Converts a run's name to a file name: forbidden characters become underscores.
fn file_name(run: &str) -> String {
    let plain = |c: char| {
        if c.is_alphanumeric() || "-_.".contains(c) {
            c
        } else {
            '_'
        }
    };
    format!("{}.csv", run.chars().map(plain).collect::<String>())
}

fn table(history: &History) -> Result<Vec<u8>, SimulateError> {
    let channels = at_10_hz(history)?;
    let rows = channels[0].len();
    let mut columns = vec![(1..=rows).map(|i| i as f64 * INTERVAL_S).collect::<Vec<f64>>()];
    columns.extend(channels);
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for row in 0..rows {
        writer.write_record(columns.iter().enumerate().map(|(i, column)| {
            // Times are multiples of 0.1 s: one decimal hides the rounding of `i * 0.1`.
            if i == 0 {
                format!("{:.1}", column[row])
            } else {
                column[row].to_string()
            }
        }))?;
    }
    let written = writer.into_inner();
    Ok(written.map_err(|e| csv::Error::from(e.into_error()))?)
}

#[cfg(test)]
mod tests {
    use super::file_name;

    #[test]
    fn a_run_cannot_leave_the_folder() {
        assert_eq!(file_name("../s 0.2"), ".._s_0.2.csv");
    }
}
