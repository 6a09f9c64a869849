//! The scatter of the soil from run to run and from preparation to preparation.

use shared::channel::Channel;
use shared::experiment::{Experiment, Scatter};
use shared::outcome::Observables;
use shared::predicted::PredictedValue;
use statistics::{CommonError, CommonErrorSize, Datum, ErrorSd};

use super::error::DataError;
use super::noise::{preparations, scatter_sd};
use crate::table::prior_entry::FreeParameter;

/// Index, among a datum's derivatives, of the one with respect to ln k*, where k* is the soil's stiffness.
pub(crate) const BY_STIFFNESS: usize = 0;
/// Index, among a datum's derivatives, of the one with respect to the logarithm of the soil's shear strength.
pub(crate) const BY_STRENGTH: usize = 1;

/// A scatter of the soil, from run to run or from preparation to preparation.
#[derive(Debug, Clone, PartialEq)]
pub struct SoilScatter {
    /// Relative standard deviation.
    pub(crate) sd: ErrorSd,
    /// The derivative along which it shifts the measurements.
    pub(crate) derivative: usize,
    /// Groups of runs that share an error, as positions among the fitted runs.
    pub(crate) groups: Vec<Vec<usize>>,
}

impl SoilScatter {
    /// Returns the scatters of an experiment.
    ///
    /// # Errors
    /// [`DataError::NoPrior`].
    pub(crate) fn all(
        experiment: &Experiment,
        fit_runs: &[usize],
        parameters: &[FreeParameter],
    ) -> Result<Vec<SoilScatter>, DataError> {
        let by_run = (0..fit_runs.len()).map(|run| vec![run]).collect();
        // The error of a single preparation is part of the parameters.
        let mut by_preparation = preparations(experiment, fit_runs);
        if by_preparation.len() < 2 {
            by_preparation.clear();
        }
        let mut scatters = Vec::new();
        for (scatter, derivative, groups) in [
            (Scatter::Run, BY_STIFFNESS, by_run),
            (Scatter::Preparation, BY_STIFFNESS, by_preparation.clone()),
            (Scatter::PreparationStrength, BY_STRENGTH, by_preparation),
        ] {
            if !groups.is_empty()
                && let Some(sd) = scatter_sd(experiment, parameters, scatter)?
            {
                scatters.push(SoilScatter {
                    sd,
                    derivative,
                    groups,
                });
            }
        }
        Ok(scatters)
    }

    /// Returns the errors of the data, one for each group.
    pub(crate) fn errors(&self, data: &[Datum]) -> Vec<CommonError> {
        // The strength of the soil does not carry the wheel and leaves its sinkage unchanged.
        let feels = |d: &Datum| self.derivative == BY_STIFFNESS || d.channel != Channel::Sinkage.index();
        let error = |runs: &Vec<usize>| CommonError {
            data: (0..data.len())
                .filter(|&i| runs.contains(&data[i].run) && feels(&data[i]))
                .collect(),
            size: CommonErrorSize::Sensitivity {
                sd: self.sd,
                derivative: self.derivative,
            },
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
        let sd = match self.sd {
            ErrorSd::Known(sd) => sd,
            ErrorSd::Inferred { parameter } => theta[parameter],
        };
        let value = match (self.derivative, channel) {
            (BY_STRENGTH, Channel::Sinkage) => return 0.0,
            (BY_STRENGTH, channel) => PredictedValue::Strength {
                channel,
                run,
                radius_m,
            },
            (_, channel) => PredictedValue::Sensitivity { channel, run },
        };
        sd * value.select(observables)
    }
}
