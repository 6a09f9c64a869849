//! The samples of a file with time histories, as they stand there.

use std::collections::BTreeMap;

use super::check::ValueError;
use super::table::{self, Columns, Row};
use crate::channel::Channel;
use crate::file::FileError;

/// The maximum number of samples of a file: a day at 10 Hz.
const MAX_SAMPLES: usize = 864_000;

/// The samples of a file: of one run, or by run where the file has a column `run`.
pub(super) struct RecordingFile {
    pub(super) name: String,
    by_run: BTreeMap<Option<String>, Samples>,
}

/// The samples of a run as they stand in their file.
#[derive(Default)]
pub(super) struct Samples {
    /// Line of each sample.
    pub(super) lines: Vec<usize>,
    /// End of the averaging interval of each sample `[s]`.
    pub(super) t_s: Vec<f64>,
    /// Travel of the sled `[m]`, never decreasing; empty if it is not recorded.
    pub(super) travel_m: Vec<f64>,
    /// Samples by channel [channel's unit]; empty if a channel is not recorded.
    pub(super) channels: [Vec<f64>; 4],
}

impl RecordingFile {
    /// Parses the samples of a file.
    ///
    /// The columns are `t_s`, the end of each sample's averaging interval, and channels; `run`, the name of the run in a file of
    /// several; `travel_m`, the travel of the sled at `t_s`; `wheel_load_n`, which `worker simulate --histories` writes, is allowed
    /// and not used.
    ///
    /// A [`FileError`] names file, line and column: fields that are blank or not finite, a travel that decreases.
    pub(super) fn parse(name: &str, text: &str) -> Result<Self, FileError> {
        let mut allowed = vec!["t_s", "run", "travel_m"];
        allowed.extend(Channel::ALL.iter().map(|c| c.column()));
        allowed.push("wheel_load_n");
        let columns = Columns {
            allowed,
            required: &["t_s"],
            max_rows: MAX_SAMPLES,
        };
        let mut by_run: BTreeMap<Option<String>, Samples> = BTreeMap::new();
        table::rows(name, text, &columns, |row, line| {
            let run = row.has("run").then(|| row.word("run").map(str::to_owned));
            by_run.entry(run.transpose()?).or_default().push(row, line)
        })?;
        let file = name.to_owned();
        Ok(RecordingFile { name: file, by_run })
    }

    /// Returns the samples of a run.
    pub(super) fn samples(&self, run: &str) -> Result<&Samples, FileError> {
        let named = || self.by_run.get(&Some(run.to_owned()));
        self.by_run.get(&None).or_else(named).ok_or_else(|| {
            let message = format!("the file has no sample of run \"{run}\"");
            FileError::whole(&self.name, message)
        })
    }
}

impl Samples {
    fn push(&mut self, row: &Row<'_>, line: usize) -> Result<(), ValueError> {
        for (channel, samples) in Channel::ALL.into_iter().zip(&mut self.channels) {
            if row.has(channel.column()) {
                samples.push(row.required(channel.column())?);
            }
        }
        if row.has("travel_m") {
            let travel_m = row.required("travel_m")?;
            if let Some(&before) = self.travel_m.last()
                && travel_m < before
            {
                return Err(ValueError::Rule(format!(
                    "travel_m {travel_m} m must be >= {before} m, the travel of the sample before"
                )));
            }
            self.travel_m.push(travel_m);
        }
        self.lines.push(line);
        self.t_s.push(row.required("t_s")?);
        Ok(())
    }
}
