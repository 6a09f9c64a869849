//! Errors that runs share: of the soil from run to run and from preparation to preparation, of the rig from session to session.

use shared::channel::Channel;
use shared::experiment::{Experiment, RigError, RigQuantity, Scatter};
use shared::outcome::Observables;
use shared::parameters::rig_parameter;
use shared::predicted::PredictedValue;
use statistics::{CommonError, CommonErrorSize, Datum, ErrorSd};

use super::error::DataError;
use super::rig_groups::{preparations, rig_groups};
use super::shared_sd::{StiffnessErrors, error_sd, scatter_sd};
use crate::table::prior_entry::FreeParameter;

/// Index, among a datum's derivatives, of the one with respect to ln k*, where k* is the soil's stiffness.
pub(crate) const BY_STIFFNESS: usize = 0;
/// Index, among a datum's derivatives, of the one with respect to the logarithm of the soil's shear strength.
pub(crate) const BY_STRENGTH: usize = 1;

/// What an error shifts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shifted {
    /// The soil's stiffness: all channels, along their derivatives by its logarithm.
    Stiffness,
    /// The soil's shear strength: all channels but the sinkage, along their derivatives by its logarithm.
    Strength,
    /// One channel, by an offset.
    Offset(Channel),
}

/// An error that groups of runs share.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedError {
    /// The error of the rig; `None` for the scatter of the soil.
    pub rig: Option<RigError>,
    /// Standard deviation: relative, or of an offset in the unit of its channel.
    pub sd: ErrorSd,
    /// What it shifts.
    pub shifted: Shifted,
    /// Groups of runs that share an error, as positions among the fitted runs.
    pub groups: Vec<Vec<usize>>,
}

impl SharedError {
    /// Returns the errors of an experiment.
    ///
    /// # Errors
    /// [`DataError::NoPrior`].
    pub(crate) fn all(
        experiment: &Experiment,
        fit_runs: &[usize],
        parameters: &[FreeParameter],
        stiffness: StiffnessErrors,
    ) -> Result<Vec<SharedError>, DataError> {
        let mut errors = soil_errors(experiment, fit_runs, parameters)?;
        for error in RigError::ALL {
            let shifted = match error.quantity {
                RigQuantity::Offset(channel) => Shifted::Offset(channel),
                RigQuantity::Stiffness if stiffness.are_inferred() => Shifted::Stiffness,
                RigQuantity::Stiffness => continue,
            };
            let is_measured = |&run: &usize| match shifted {
                Shifted::Offset(channel) => experiment.runs[run].measured[channel.index()].is_some(),
                _ => true,
            };
            let groups = rig_groups(experiment, fit_runs, error.column);
            if groups.is_empty() || !fit_runs.iter().any(is_measured) {
                continue;
            }
            if let Some(sd) = error_sd(experiment.noise.rig(error), rig_parameter(error), parameters)? {
                errors.push(SharedError {
                    rig: Some(error),
                    sd,
                    shifted,
                    groups,
                });
            }
        }
        Ok(errors)
    }

    /// Returns the errors of the data, one for each group.
    pub(crate) fn errors(&self, data: &[Datum]) -> Vec<CommonError> {
        let sensitivity = |derivative| CommonErrorSize::Sensitivity {
            sd: self.sd,
            derivative,
        };
        let size = match self.shifted {
            Shifted::Stiffness => sensitivity(BY_STIFFNESS),
            Shifted::Strength => sensitivity(BY_STRENGTH),
            Shifted::Offset(_) => CommonErrorSize::Shift(self.sd),
        };
        // The strength of the soil does not carry the wheel and leaves its sinkage unchanged.
        let feels = |d: &Datum| match self.shifted {
            Shifted::Stiffness => true,
            Shifted::Strength => d.channel != Channel::Sinkage.index(),
            Shifted::Offset(channel) => d.channel == channel.index(),
        };
        let error = |runs: &Vec<usize>| CommonError {
            data: (0..data.len())
                .filter(|&i| runs.contains(&data[i].run) && feels(&data[i]))
                .collect(),
            size: size.clone(),
        };
        self.groups.iter().map(error).collect()
    }

    /// Returns one standard deviation of its contribution to a channel of a run [channel's unit].
    ///
    /// # Arguments
    /// - `theta`: the parameters. `observables`: of the runs, with their derivatives by the stiffness where they scatter.
    /// - `radius_m`: radius of the run's wheel `[m]`.
    pub fn shift(
        &self,
        theta: &[f64],
        observables: &Observables,
        (channel, run): (Channel, usize),
        radius_m: f64,
    ) -> f64 {
        let sd = self.sd.at(theta);
        let value = match (self.shifted, channel) {
            (Shifted::Offset(shifted), channel) if shifted == channel => return sd,
            (Shifted::Offset(_), _) | (Shifted::Strength, Channel::Sinkage) => return 0.0,
            (Shifted::Strength, channel) => PredictedValue::Strength {
                channel,
                run,
                radius_m,
            },
            (Shifted::Stiffness, channel) => PredictedValue::Sensitivity { channel, run },
        };
        sd * value.select(observables)
    }
}

/// Returns the scatter of the soil from run to run and from preparation to preparation.
fn soil_errors(
    experiment: &Experiment,
    fit_runs: &[usize],
    parameters: &[FreeParameter],
) -> Result<Vec<SharedError>, DataError> {
    let by_run = (0..fit_runs.len()).map(|run| vec![run]).collect();
    // The error of a single preparation is part of the parameters.
    let mut by_preparation = preparations(experiment, fit_runs);
    if by_preparation.len() < 2 {
        by_preparation.clear();
    }
    let mut errors = Vec::new();
    for (scatter, shifted, groups) in [
        (Scatter::Run, Shifted::Stiffness, by_run),
        (Scatter::Preparation, Shifted::Stiffness, by_preparation.clone()),
        (Scatter::PreparationStrength, Shifted::Strength, by_preparation),
    ] {
        if !groups.is_empty()
            && let Some(sd) = scatter_sd(experiment, parameters, scatter)?
        {
            errors.push(SharedError {
                rig: None,
                sd,
                shifted,
                groups,
            });
        }
    }
    Ok(errors)
}
