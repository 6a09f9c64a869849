//! The standard deviations of errors that tests or runs share: stated, or inferred as parameters.

use shared::channel::Channel;
use shared::experiment::{Experiment, RigError, RigQuantity, RunUse, Scatter, ScatterSd};
use shared::parameters::{NOISE_PREFIX, rig_parameter, scatter_parameter};
use statistics::ErrorSd;

use super::bevameter_readings::BevameterReadings;
use super::error::DataError;
use super::rig_groups::{preparations, rig_groups};
use crate::table::prior_entry::FreeParameter;

/// The properties of a model on which it depends whether an error of the soil's stiffness can be inferred.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StiffnessErrors {
    /// Whether the model gives derivatives by the stiffness.
    pub(crate) has_derivatives: bool,
    /// Whether the likelihood infers a discrepancy for each channel, which an error of several channels would join to one.
    pub(crate) has_unknown_discrepancy: bool,
}

impl StiffnessErrors {
    /// Returns whether errors of the stiffness by session and operator are part of the likelihood.
    pub(crate) fn are_inferred(self) -> bool {
        self.has_derivatives && !self.has_unknown_discrepancy
    }
}

/// The standard deviation of an error that tests or runs share.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SharedSd {
    /// Name of the parameter, if it is inferred.
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    /// Scale of the half-normal prior.
    pub(crate) prior_scale: f64,
    pub(crate) stated: ScatterSd,
    /// Whether a fitted measurement has the error.
    pub(crate) is_needed: bool,
}

impl SharedSd {
    /// Returns the sds of all errors that tests or runs share.
    pub(crate) fn all(
        experiment: &Experiment,
        bevameter: &BevameterReadings,
        stiffness: StiffnessErrors,
    ) -> Vec<SharedSd> {
        let scatter = |scatter: Scatter| SharedSd {
            name: scatter_parameter(scatter),
            unit: "1",
            prior_scale: scatter.prior_scale(),
            stated: experiment.noise.scatter(scatter),
            is_needed: needs_scatter(experiment, bevameter, scatter),
        };
        let rig = |error: RigError| SharedSd {
            name: rig_parameter(error),
            unit: error.unit(),
            prior_scale: error.prior_scale(),
            stated: experiment.noise.rig(error),
            is_needed: needs_rig(experiment, error, stiffness),
        };
        let scatters = Scatter::ALL.into_iter().map(scatter);
        scatters.chain(RigError::ALL.into_iter().map(rig)).collect()
    }

    /// Returns whether it is a parameter of the calibration.
    pub(crate) fn is_inferred(&self) -> bool {
        self.stated == ScatterSd::Unknown && self.is_needed
    }

    /// Returns the key under `[noise]`.
    pub(crate) fn key(&self) -> &str {
        self.name.strip_prefix(NOISE_PREFIX).unwrap_or(&self.name)
    }
}

/// Returns whether any fitted measurement has this scatter.
fn needs_scatter(experiment: &Experiment, bevameter: &BevameterReadings, scatter: Scatter) -> bool {
    let fitted = || Channel::ALL.iter().any(|&c| experiment.measures(c, RunUse::Fit));
    match scatter {
        Scatter::Run => fitted(),
        Scatter::Preparation | Scatter::PreparationStrength => {
            fitted() && preparations(experiment, &fit_runs(experiment)).len() > 1
        }
        Scatter::PlateTest | Scatter::PlateReading | Scatter::RingTest | Scatter::RingReading => {
            bevameter.scatters(scatter)
        }
    }
}

/// Returns whether any fitted measurement has this error of the rig.
fn needs_rig(experiment: &Experiment, error: RigError, stiffness: StiffnessErrors) -> bool {
    let is_measured = match error.quantity {
        RigQuantity::Offset(channel) => experiment.measures(channel, RunUse::Fit),
        RigQuantity::Stiffness => {
            let fitted = Channel::ALL.iter().any(|&c| experiment.measures(c, RunUse::Fit));
            fitted && stiffness.are_inferred()
        }
    };
    is_measured && !rig_groups(experiment, &fit_runs(experiment), error.column).is_empty()
}

fn fit_runs(experiment: &Experiment) -> Vec<usize> {
    let runs = 0..experiment.runs.len();
    runs.filter(|&i| experiment.runs[i].usage == RunUse::Fit)
        .collect()
}

/// Returns an inferred or stated sd; `None` if it is 0.
///
/// # Errors
/// [`DataError::NoPrior`] if an inferred sd has no parameter.
pub(crate) fn error_sd(
    stated: ScatterSd,
    name: String,
    parameters: &[FreeParameter],
) -> Result<Option<ErrorSd>, DataError> {
    match stated {
        ScatterSd::Known(sd) => Ok((sd > 0.0).then_some(ErrorSd::Known(sd))),
        ScatterSd::Unknown => {
            let parameter = parameters.iter().position(|p| p.name == name);
            let parameter = parameter.ok_or(DataError::NoPrior(name))?;
            Ok(Some(ErrorSd::Inferred { parameter }))
        }
    }
}

/// Returns the relative sd of a scatter; `None` if it is 0. Errors are those of [`error_sd`].
pub(crate) fn scatter_sd(
    experiment: &Experiment,
    parameters: &[FreeParameter],
    scatter: Scatter,
) -> Result<Option<ErrorSd>, DataError> {
    let name = scatter_parameter(scatter);
    error_sd(experiment.noise.scatter(scatter), name, parameters)
}
