//! The split into fitted and holdout runs, with the likelihood of the fitted measurements.

use shared::experiment::{Experiment, RunUse};
use shared::predicted::PredictedValue;
use statistics::Likelihood;

use crate::data::bevameter_readings::BevameterReadings;
use crate::data::error::DataError;
use crate::data::likelihood::likelihood;
use crate::data::predicted_values::predicted_values;
use crate::data::shared_error::SharedError;
use crate::data::shared_sd::StiffnessErrors;
use crate::data::transient_readings::TransientReadings;
use crate::table::likelihood_settings::LikelihoodSettings;
use crate::table::prior_entry::FreeParameter;

/// The split into fitted and holdout runs, with the likelihood of the fitted measurements.
pub(super) struct Fitted {
    /// The fitted runs, as positions in the experiment.
    pub(super) fit_runs: Vec<usize>,
    /// The runs that are not fitted, as positions in the experiment.
    pub(super) holdout_runs: Vec<usize>,
    pub(super) shared_errors: Vec<SharedError>,
    pub(super) likelihood: Likelihood,
    /// The observables that the likelihood takes.
    pub(super) predicted: Vec<PredictedValue>,
}

impl Fitted {
    pub(super) fn new(
        experiment: &Experiment,
        readings: (&BevameterReadings, &TransientReadings),
        parameters: &[FreeParameter],
        settings: LikelihoodSettings,
        stiffness: StiffnessErrors,
    ) -> Result<Fitted, DataError> {
        let (fit_runs, holdout_runs): (Vec<usize>, Vec<usize>) =
            (0..experiment.runs.len()).partition(|&i| experiment.runs[i].usage == RunUse::Fit);
        let shared = SharedError::all(experiment, &fit_runs, parameters, stiffness)?;
        let likelihood = likelihood(experiment, &fit_runs, readings, parameters, &shared, settings)?;
        let radius = |&i: &usize| experiment.wheels[&experiment.runs[i].wheel].radius_m;
        let radii_m: Vec<f64> = fit_runs.iter().map(radius).collect();
        Ok(Fitted {
            predicted: predicted_values(&likelihood, &radii_m),
            fit_runs,
            holdout_runs,
            shared_errors: shared,
            likelihood,
        })
    }
}
