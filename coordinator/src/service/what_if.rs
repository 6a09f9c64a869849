//! What would be concluded without some runs: a study beside the one that has them.

use std::collections::BTreeSet;

use shared::api::{CalibrationCreated, NewCalibration, NewExperiment};
use shared::experiment::Experiment;
use shared::file::FileError;

use super::error::ServiceError;
use super::handle::Service;
use job::{continued_job, searching_job};

/// More runs are counted in the name of the study, not listed.
const MOST_LISTED: usize = 3;

impl Service {
    /// Begins a study of the job of a calibration with some of its runs held out, and with a search of its model.
    ///
    /// # Errors
    /// [`ServiceError`]: a run is unknown, or the experiment with these runs held out is refused.
    pub async fn what_if(
        &self,
        id: i64,
        without: &BTreeSet<String>,
    ) -> Result<CalibrationCreated, ServiceError> {
        if without.is_empty() {
            return Err(FileError::whole("without", "no run is named").into());
        }
        let row = self.searchable(id).await?;
        let experiment = self.experiment(row.experiment).await?;
        let held = Experiment::holding_out("experiment.toml", &experiment, without)?;
        let experiment = NewExperiment {
            toml: held.toml,
            files: held.files,
        };
        let job = continued_job("job.toml", &row.job)?;
        let job = searching_job("job.toml", &job)?;
        let listed: Vec<&str> = without.iter().map(String::as_str).collect();
        let name = match listed.len() {
            ..=MOST_LISTED => format!("{} without {}", row.name, listed.join(", ")),
            many => format!("{} without {many} runs", row.name),
        };
        let new = NewCalibration {
            experiment: self.add_experiment(experiment).await?,
            toml: job.toml,
            files: job.files,
            name: Some(name),
            webhook: None,
        };
        self.add_calibration(new).await
    }
}
