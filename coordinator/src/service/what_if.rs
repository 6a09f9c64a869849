//! What-if studies, which repeat a calibration without some of its fitted runs.

use shared::api::{CalibrationCreated, NewCalibration, NewExperiment};
use shared::experiment::Experiment;

use super::background::in_background;
use super::error::ServiceError;
use super::handle::Service;
use job::{Spec, searched_job};

/// The largest number of runs that a name lists.
const MAX_NAMED: usize = 3;

impl Service {
    /// Begins a study with the job of a calibration, in which these fitted runs are held out, and a search for a missing effect.
    ///
    /// # Errors
    /// [`ServiceError`]: a run is unknown or held out already, or none is left to fit; the calibration is a search.
    pub async fn what_if(&self, id: i64, without: Vec<String>) -> Result<CalibrationCreated, ServiceError> {
        let row = self.calibration_row(id).await?;
        if row.membership.is_search() {
            return Err(ServiceError::Search(id));
        }
        let files = self.experiment(row.experiment).await?;
        let name = name(&row.name, &without);
        let job = searched_job("job.toml", &row.job)?;
        let trial = job.clone();
        // The job is validated before anything is stored.
        let edited = in_background(move || {
            let edited = Experiment::with_held_out("experiment.toml", &files, &without)?;
            Spec::new("job.toml", &trial, "experiment.toml", &edited)?;
            Ok::<_, ServiceError>(edited)
        });
        let edited = edited.await?;
        let experiment = self.add_experiment(NewExperiment {
            toml: edited.toml,
            files: edited.files,
        });
        let new = NewCalibration {
            experiment: experiment.await?,
            toml: job.toml,
            files: job.files,
            name: Some(name),
            webhook: None,
        };
        self.add_calibration(new).await
    }
}

fn name(name: &str, without: &[String]) -> String {
    match without.len() > MAX_NAMED {
        true => format!("{name} without {} runs", without.len()),
        false => format!("{name} without {}", without.join(", ")),
    }
}
