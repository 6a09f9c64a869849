//! The check that an external model can predict an experiment.

use shared::channel::Channel;
use shared::experiment::Experiment;
use shared::model::{ExternalModel, RunInput};
use statistics::Likelihood;

use super::shared_error::BY_STIFFNESS;

/// Checks that the model predicts the measured channels, and that nothing needs a property that only built-in models have.
///
/// # Errors
/// A sentence with everything that the model lacks.
pub(crate) fn check(
    model: &ExternalModel,
    experiment: &Experiment,
    fit_runs: &[usize],
    likelihood: &Likelihood,
) -> Result<(), String> {
    let mut wrong = Vec::new();
    let name = model.source.name();
    for channel in Channel::ALL {
        let mut runs = fit_runs.iter().map(|&run| &experiment.runs[run]);
        let is_measured = runs.any(|run| run.measured[channel.index()].is_some());
        if is_measured && !model.outputs.contains(&channel) {
            wrong.push(format!(
                "{} is measured, but is not among the outputs of {name}",
                channel.column()
            ));
        }
    }
    if !experiment.plates.is_empty() || !experiment.shear.is_empty() {
        wrong.push(format!(
            "plates and shear readings follow from the soil of quasi_static and scm, and {name} is neither: leave them out of the experiment"
        ));
    }
    if likelihood
        .sensitive()
        .iter()
        .any(|error| error.derivative == BY_STIFFNESS)
    {
        wrong.push(format!(
            "scatter of the soil's stiffness needs derivatives by the stiffness, which {name} does not give: set it to 0 under [noise]"
        ));
    }
    let mut angles = experiment.runs.iter().map(|run| run.slip_angle_deg);
    if !model.takes(RunInput::SlipAngleDeg) && angles.any(|angle| angle.abs() > 0.0) {
        wrong.push(format!(
            "runs have a slip angle, but slip_angle_deg is not among the inputs of {name}"
        ));
    }
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(wrong.join("; ")),
    }
}
