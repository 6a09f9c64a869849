//! Sinkages before the steady state as data: points of the recordings of fitted runs.
//!
//! The average of a recording is a datum of its own, so its history is scored given the average: the prediction settles to the measured
//! steady sinkage. Scored with the model's, the history would tell the error of the average again.
//!
//! Two errors add up: a scatter of each reading between repeats of a condition, and an error of the model that the repeats share, which is
//! autocorrelated along the travel. Both are stationary, which is an approximation: start and end of the prediction are measured.

use shared::experiment::{Experiment, RunUse, TestRun, Transient};
use shared::model::{ModelVariant, TransientCondition};
use shared::parameters::{TRANSIENT_ERROR_LENGTH, TRANSIENT_ERROR_SD, TRANSIENT_ERRORS, TRANSIENT_SCATTER};
use statistics::{CommonError, Datum, Distribution, ErrorSd, Marginal};

use super::bevameter_readings::{PLATE, RING};
use super::error::DataError;
use super::noise::conditions;
use crate::table::prior_entry::FreeParameter;

/// The channel of sinkages before the steady state among the data, behind those of the wheel and the bevameter; the run of a datum is its
/// position among the fitted runs.
pub const TRANSIENT: usize = 6;

/// Prior median of the scatter between repeats `[m]`: CMU's runs have 0.65 mm. Near zero the prior must vanish, because a few points that a
/// model meets exactly have no bound on their density.
const SCATTER_MEDIAN_M: f64 = 5e-4;
/// Prior factor of one standard deviation of the scatter.
const SCATTER_FACTOR: f64 = 2.0;
/// Prior scale of the sd of the model's error `[m]`: CMU's runs have 1.3 mm.
const ERROR_SCALE_M: f64 = 0.002;
/// Prior median of the correlation length over the mean length of the contact: errors of CMU's runs are correlated over 2 of them.
const CORRELATION_CONTACT_LENGTHS: f64 = 2.0;
/// Prior factor of one standard deviation of the correlation length.
const LENGTH_FACTOR: f64 = 1.6;

/// Returns whether a datum of a channel belongs to a run of the wheel; the others are readings of a bevameter.
pub fn is_of_run(channel: usize) -> bool {
    ![PLATE, RING].contains(&channel)
}

/// The transient of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunTransient {
    /// Position of the run among the fitted runs, or among the holdout runs.
    pub run: usize,
    /// The recorded sinkage before the steady state.
    pub transient: Transient,
}

/// The recorded transients of an experiment, if the job uses them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TransientReadings {
    /// The transients of the fitted runs, in their order.
    pub fitted: Vec<RunTransient>,
    /// The transients of the holdout runs, in their order.
    pub holdout: Vec<RunTransient>,
    /// The points that are data: those of each condition together, with ascending travel.
    data: Vec<Vec<TransientDatum>>,
}

/// A point of a transient that is a datum.
#[derive(Debug, Clone, PartialEq)]
struct TransientDatum {
    /// Position of its transient among the fitted ones.
    transient: usize,
    /// Travel since the beginning of the slip `[m]`.
    travel_m: f64,
    /// Recorded sinkage `[m]`.
    sinkage_m: f64,
}

impl TransientReadings {
    /// Returns the recorded transients of an experiment.
    ///
    /// # Errors
    /// [`DataError::NoTransients`]: no fitted run has one.
    pub(crate) fn new(experiment: &Experiment) -> Result<Self, DataError> {
        let slip_begins_m = experiment.protocol.slip_begins_m.unwrap_or(0.0);
        let of_runs = |usage: RunUse| {
            let runs = experiment.runs.iter().filter(|run| run.usage == usage);
            let transient = |(position, run): (usize, &TestRun)| {
                let transient = Transient::new(run, &experiment.wheels[&run.wheel], slip_begins_m)?;
                let run = position;
                Some(RunTransient { run, transient })
            };
            runs.enumerate().filter_map(transient).collect()
        };
        let fitted: Vec<RunTransient> = of_runs(RunUse::Fit);
        let fit_runs: Vec<usize> = (0..experiment.runs.len())
            .filter(|&run| experiment.runs[run].usage == RunUse::Fit)
            .collect();
        let of_condition = |runs: Vec<usize>| {
            let members = (0..fitted.len()).filter(|&transient| runs.contains(&fitted[transient].run));
            let mut data: Vec<TransientDatum> = members
                .flat_map(|transient| {
                    let points = fitted[transient].transient.data();
                    points
                        .into_iter()
                        .map(move |[travel_m, sinkage_m]| TransientDatum {
                            transient,
                            travel_m,
                            sinkage_m,
                        })
                })
                .collect();
            data.sort_by(|a, b| a.travel_m.total_cmp(&b.travel_m));
            data
        };
        let data = conditions(experiment, &fit_runs)
            .into_iter()
            .map(of_condition)
            .collect();
        let readings = TransientReadings {
            fitted,
            holdout: of_runs(RunUse::Holdout),
            data,
        };
        match readings.points() {
            0 => Err(DataError::NoTransients),
            _ => Ok(readings),
        }
    }

    /// Returns the number of points that are data.
    pub fn points(&self) -> usize {
        self.data.iter().map(Vec::len).sum()
    }

    /// Adds the sds and the correlation length of the errors if the job has no prior for them.
    ///
    /// # Errors
    /// [`DataError::NotNeeded`]: the job has such a prior without transients.
    pub(crate) fn add_parameters(&self, parameters: &mut Vec<FreeParameter>) -> Result<(), DataError> {
        let is_stated = |parameters: &[FreeParameter], name: &str| parameters.iter().any(|p| p.name == name);
        if self.fitted.is_empty() {
            return match TRANSIENT_ERRORS
                .into_iter()
                .find(|name| is_stated(parameters, name))
            {
                Some(name) => Err(DataError::NotNeeded {
                    name: name.to_owned(),
                    nothing: "no history that is fitted",
                }),
                None => Ok(()),
            };
        }
        let contacts_m = self.fitted.iter().map(|run| run.transient.contact_m);
        let mean_m = contacts_m.sum::<f64>() / self.fitted.len() as f64;
        let lognormal = |median, factor| Distribution::Lognormal { median, factor };
        let length = lognormal(CORRELATION_CONTACT_LENGTHS * mean_m, LENGTH_FACTOR);
        let scatter = lognormal(SCATTER_MEDIAN_M, SCATTER_FACTOR);
        let error = Distribution::HalfNormal { scale: ERROR_SCALE_M };
        for (name, prior) in [
            (TRANSIENT_SCATTER, scatter),
            (TRANSIENT_ERROR_SD, error),
            (TRANSIENT_ERROR_LENGTH, length),
        ] {
            if !is_stated(parameters, name) {
                parameters.push(FreeParameter {
                    name: name.to_owned(),
                    unit: "m".to_owned(),
                    marginal: Marginal::new(prior, None)?,
                });
            }
        }
        Ok(())
    }

    /// Makes the variant of the fitted runs predict the points: those that are data, each as a transient of its own in the order of the
    /// data, then those by which the model is judged.
    pub(crate) fn ask_fitted(&self, variant: &mut ModelVariant) {
        let data = self.data.iter().flatten().map(|datum| {
            let run = &self.fitted[datum.transient];
            run.condition(vec![datum.travel_m], Some(run.transient.steady_sinkage_m))
        });
        let judged = self.fitted.iter().map(RunTransient::judged);
        variant.transients = data.chain(judged).collect();
    }

    /// Makes the variant of the holdout runs predict the points by which the model is judged.
    pub(crate) fn ask_holdout(&self, variant: &mut ModelVariant) {
        variant.transients = self.holdout.iter().map(RunTransient::judged).collect();
    }

    /// Leaves in a variant of the fitted runs the points that are data.
    pub(crate) fn keep_data(&self, variant: &mut ModelVariant) {
        variant.transients.truncate(self.points());
    }

    /// Appends the points that are data, and their errors.
    ///
    /// # Errors
    /// [`DataError::NoPrior`]; [`DataError::Likelihood`].
    pub(crate) fn append(
        &self,
        parameters: &[FreeParameter],
        data: &mut Vec<Datum>,
        common: &mut Vec<CommonError>,
    ) -> Result<(), DataError> {
        if self.fitted.is_empty() {
            return Ok(());
        }
        let inferred = |name: &str| {
            let parameter = parameters.iter().position(|p| p.name == name);
            let parameter = parameter.ok_or_else(|| DataError::NoPrior(name.to_owned()))?;
            Ok::<_, DataError>(ErrorSd::Inferred { parameter })
        };
        let scatter = inferred(TRANSIENT_SCATTER)?;
        let (sd, length_m) = (inferred(TRANSIENT_ERROR_SD)?, inferred(TRANSIENT_ERROR_LENGTH)?);
        for condition in &self.data {
            let places: Vec<usize> = (data.len()..data.len() + condition.len()).collect();
            let travel_m: Vec<f64> = condition.iter().map(|datum| datum.travel_m).collect();
            data.extend(condition.iter().map(|datum| Datum {
                run: self.fitted[datum.transient].run,
                channel: TRANSIENT,
                value: datum.sinkage_m,
                sd: scatter,
            }));
            common.extend(CommonError::of_history(&places, &travel_m, sd, length_m)?);
        }
        Ok(())
    }
}

impl RunTransient {
    /// Returns the points by which the model is judged, on the way to its own steady sinkage.
    fn judged(&self) -> TransientCondition {
        let points = self.transient.track();
        self.condition(points.iter().map(|[travel_m, _]| *travel_m).collect(), None)
    }

    fn condition(&self, travel_m: Vec<f64>, steady_sinkage_m: Option<f64>) -> TransientCondition {
        TransientCondition {
            run: self.run,
            start_sinkage_m: self.transient.start_sinkage_m,
            steady_sinkage_m,
            travel_m,
        }
    }
}
