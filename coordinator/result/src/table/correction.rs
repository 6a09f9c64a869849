//! Correction of predictions by the model's errors in the fitted conditions, with a Gaussian process for each channel.

use std::collections::BTreeMap;

use inference::diagnostics::{mean, mean_and_sd};
use inference::discrepancy::{Discrepancy, DiscrepancyComponent, DiscrepancyProcess, Misfit};
use shared::channel::Channel;
use shared::experiment::TestRun;
use shared::outcome::Observables;

use super::conditions::{Conditions, repeated};
use super::corrected::Corrected;
use super::fixed_sigma::FixedSigmas;
use super::mixture::{Component, quantile};
use super::predictive::{Predictive, RunPosition, accepted, shared_error};
use crate::finished_calibration::FinishedCalibration;
use crate::words::number;

/// The correction of each channel of a calibration, or the reason why there is none.
#[derive(Debug)]
pub struct Corrections<'a> {
    calibration: &'a FinishedCalibration,
    channels: BTreeMap<Channel, Result<Correction, String>>,
}

impl<'a> Corrections<'a> {
    /// Infers the discrepancy of each channel from the fitted conditions.
    pub fn new(calibration: &'a FinishedCalibration) -> Self {
        let sigmas = FixedSigmas::new(calibration);
        let correction = |channel: Channel| {
            let sigma = sigmas
                .get(channel)
                .ok_or(format!("{} has no noise", channel.words()))?;
            Correction::new(calibration, channel, sigma.sd, Basis::Model)
        };
        Corrections {
            calibration,
            channels: Channel::ALL
                .into_iter()
                .map(|channel| (channel, correction(channel)))
                .collect(),
        }
    }

    /// Returns the corrected prediction of a run and channel, or why there is none. In a fitted condition, the correction rests on the
    /// other conditions.
    ///
    /// # Arguments
    /// - `run`: position in the experiment. `model`: what the model says of it.
    ///
    /// # Errors
    /// A sentence: the channel has no discrepancy, or not at this run.
    pub fn at(&self, run: usize, channel: Channel, model: Predictive) -> Result<Corrected, String> {
        let correction = self.channels[&channel].as_ref().map_err(Clone::clone)?;
        correction.at(self.calibration, run, (model.mean, model.interval.is_some()))
    }

    /// Returns the discrepancy of each fitted run of a channel, predicted from the runs of all other levels: each level of each condition
    /// is left out in turn, with the model's parameters kept, so a run stands here once for each condition that has levels.
    pub fn between_levels(&self, channel: Channel) -> Vec<(usize, f64)> {
        let correction = self.channels[&channel].as_ref();
        correction.map_or_else(|_| Vec::new(), Correction::between_levels)
    }
}

/// What predicts the fitted measurements before their misfits are interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Basis {
    /// The calibrated model.
    Model,
    /// The mean of the conditions. The misfits have a plane then, because nothing else says how measurements change with the conditions.
    Mean,
}

/// The discrepancy of a channel over the conditions of the rig.
#[derive(Debug)]
pub(super) struct Correction {
    channel: Channel,
    conditions: Conditions,
    /// Wheel, soil and pass of each group, in the order of the group numbers in the process.
    groups: Vec<Group>,
    /// The fitted runs behind each misfit, as positions in the experiment.
    members: Vec<Vec<usize>>,
    /// Coordinates of each misfit.
    points: Vec<Vec<f64>>,
    /// Mean of the measured conditions [channel's unit].
    pub(super) mean: f64,
    /// Number of each final draw that the model accepts, with its mean prediction in each condition; empty without a model.
    draws: Vec<(usize, Vec<f64>)>,
    process: DiscrepancyProcess,
    noise_sd: f64,
}

/// Wheel, soil and pass, among which the discrepancy may differ by a constant.
type Group = (String, String, u32);

fn group(run: &TestRun) -> Group {
    (run.wheel.clone(), run.soil.clone(), run.pass)
}

impl Correction {
    pub(super) fn new(
        calibration: &FinishedCalibration,
        channel: Channel,
        noise_sd: f64,
        basis: Basis,
    ) -> Result<Self, String> {
        let spec = &calibration.spec;
        let all = &spec.experiment.runs;
        let measured = |run: usize| all[run].measured[channel.index()];
        let fitted = spec.fit_runs.iter().filter(|&&run| measured(run).is_some());
        let fitted: Vec<usize> = fitted.copied().collect();
        let runs: Vec<&TestRun> = fitted.iter().map(|&run| &all[run]).collect();
        let conditions = Conditions::new(&runs);
        let min = DiscrepancyProcess::min_misfits(conditions.axes.len());
        let members = repeated(&runs);
        let name = channel.words();
        let max = DiscrepancyProcess::MAX_MISFITS;
        if members.len() > max {
            let count = members.len();
            return Err(format!(
                "{name} has {count} fitted conditions, and a discrepancy is computed for at most {max}"
            ));
        }
        if conditions.axes.is_empty() || members.len() < min {
            return Err(match runs.len() {
                0 => format!("{name} has no fitted measurement"),
                _ if conditions.axes.is_empty() => format!("{name} was fitted in one condition"),
                _ => format!(
                    "{name} has {}, and a discrepancy over {} needs {min}",
                    number::count(members.len(), "fitted condition"),
                    conditions.names()
                ),
            });
        }
        let positions = |repeats: Vec<usize>| repeats.into_iter().map(|i| fitted[i]).collect();
        let members: Vec<Vec<usize>> = members.into_iter().map(positions).collect();
        let mut groups: Vec<Group> = runs.iter().map(|&run| group(run)).collect();
        groups.sort();
        groups.dedup();
        let draws = match basis {
            Basis::Model => means(calibration, channel, &members),
            Basis::Mean => Vec::new(),
        };
        let value = |repeated: &Vec<usize>| {
            let values: Vec<f64> = repeated.iter().filter_map(|&run| measured(run)).collect();
            mean(&values)
        };
        let measured_means: Vec<f64> = members.iter().filter_map(value).collect();
        let mean_of_all = mean(&measured_means).unwrap_or_default();
        let misfit = |(condition, repeated): (usize, &Vec<usize>)| {
            let repeats: Vec<&TestRun> = repeated.iter().map(|&run| &all[run]).collect();
            let modelled: Vec<f64> = draws.iter().map(|(_, means)| means[condition]).collect();
            let predicted = match basis {
                Basis::Model => mean(&modelled)?,
                Basis::Mean => mean_of_all,
            };
            let variances = repeated
                .iter()
                .map(|&run| noise_variance(calibration, run, channel, noise_sd));
            Some(Misfit {
                point: conditions.mean_point(&repeats),
                group: groups.binary_search(&group(repeats[0])).ok()?,
                value: value(repeated)? - predicted,
                noise_variance: variances.sum::<f64>() / (repeated.len() * repeated.len()) as f64,
            })
        };
        let misfits: Option<Vec<Misfit>> = members.iter().enumerate().map(misfit).collect();
        let misfits = misfits.unwrap_or_default();
        let process = match basis {
            Basis::Model => DiscrepancyProcess::through(&misfits),
            Basis::Mean => DiscrepancyProcess::about_a_plane(&misfits),
        };
        Ok(Correction {
            channel,
            points: misfits.into_iter().map(|misfit| misfit.point).collect(),
            groups,
            mean: mean_of_all,
            draws,
            process: process.ok_or(format!("{name} has no discrepancy that can be computed"))?,
            members,
            conditions,
            noise_sd,
        })
    }

    /// Returns the corrected prediction of a run, or why there is none.
    ///
    /// # Arguments
    /// - `run`: position in the experiment. `(value, is_distributed)`: the value to correct, and whether it has a distribution.
    pub(super) fn at(
        &self,
        calibration: &FinishedCalibration,
        run: usize,
        (value, is_distributed): (f64, bool),
    ) -> Result<Corrected, String> {
        let predicted = &calibration.spec.experiment.runs[run];
        if let Some(reason) = self.conditions.reason_beside(self.channel.words(), predicted) {
            return Err(reason);
        }
        let discrepancy = match self.members.iter().position(|members| members.contains(&run)) {
            Some(condition) => {
                let left_out = self.process.without(&[condition]).and_then(|mut left| left.pop());
                left_out.ok_or_else(|| format!("{} is singular without a condition", self.channel.words()))?
            }
            // The process treats a number after the fitted groups as a group without data.
            None => self.process.at(
                &self.conditions.point(predicted),
                self.groups
                    .binary_search(&group(predicted))
                    .unwrap_or(self.groups.len()),
            ),
        };
        let (shift, spread) = self.paired(calibration, run, &discrepancy);
        let noise = noise_variance(calibration, run, self.channel, self.noise_sd);
        let component = |part: &DiscrepancyComponent| Component {
            mean: value + part.mean + shift,
            scale: Some((part.variance + spread * spread + noise).sqrt()),
            weight: part.probability,
        };
        let components: Vec<Component> = discrepancy.components.iter().map(component).collect();
        let law = calibration.spec.likelihood.law();
        Ok(Corrected {
            mean: value + discrepancy.mean() + shift,
            interval: is_distributed.then(|| [0.05, 0.95].map(|p| quantile(&components, law, p))),
        })
    }

    /// Returns each fitted run with the discrepancy that the process predicts for it without a level; levels whose precision is singular to
    /// rounding are passed over.
    pub(super) fn between_levels(&self) -> Vec<(usize, f64)> {
        let mut predicted = Vec::new();
        for level in self.conditions.levels(&self.points) {
            for (&condition, discrepancy) in level
                .iter()
                .zip(self.process.without(&level).into_iter().flatten())
            {
                predicted.extend(
                    self.members[condition]
                        .iter()
                        .map(|&run| (run, discrepancy.mean())),
                );
            }
        }
        predicted
    }

    /// Compares each draw's prediction of the run with its predictions of the fitted conditions. Returns a mean shift, which is not 0 if
    /// the model refuses some draws in this run only, and the standard deviation of the corrected value. A change of the draw that moves
    /// all predictions alike cancels.
    fn paired(&self, calibration: &FinishedCalibration, run: usize, discrepancy: &Discrepancy) -> (f64, f64) {
        let values = values(calibration, run, self.channel);
        let taken = |means: &[f64]| -> f64 {
            let weighted = means.iter().zip(&discrepancy.weights);
            weighted.map(|(mean, weight)| mean * weight).sum()
        };
        let all: Vec<f64> = self.draws.iter().map(|(_, means)| taken(means)).collect();
        let pairs = self.draws.iter().zip(&all);
        let pairs = pairs.filter_map(|((number, _), taken)| Some((values.get(number)?, *taken)));
        let (corrected, paired): (Vec<f64>, Vec<f64>) =
            pairs.map(|(value, taken)| (value - taken, taken)).unzip();
        let shift = mean(&all)
            .zip(mean(&paired))
            .map_or(0.0, |(all, paired)| all - paired);
        (shift, mean_and_sd(&corrected).map_or(0.0, |(_, sd)| sd))
    }
}

/// Returns, for each final draw that the model accepts, its number and the channel's mean over the runs of each condition.
fn means(
    calibration: &FinishedCalibration,
    channel: Channel,
    members: &[Vec<usize>],
) -> Vec<(usize, Vec<f64>)> {
    let of_runs: Vec<Vec<BTreeMap<usize, f64>>> = members
        .iter()
        .map(|runs| {
            runs.iter()
                .map(|&run| values(calibration, run, channel))
                .collect()
        })
        .collect();
    let numbers = of_runs[0][0].keys();
    let of_draw = |number: &usize| {
        let of_condition = |runs: &Vec<BTreeMap<usize, f64>>| {
            let values: Option<Vec<f64>> = runs.iter().map(|values| values.get(number).copied()).collect();
            mean(&values?)
        };
        let means: Option<Vec<f64>> = of_runs.iter().map(of_condition).collect();
        Some((*number, means?))
    };
    numbers.filter_map(of_draw).collect()
}

/// Returns the model's values of a run and channel, keyed by the number of the final draw.
fn values(calibration: &FinishedCalibration, run: usize, channel: Channel) -> BTreeMap<usize, f64> {
    let Some(place) = RunPosition::find(&calibration.spec, run) else {
        return BTreeMap::new();
    };
    let of_draw = |(number, _, observables, position): (usize, _, &Observables, usize)| {
        Some((number, *observables.channel(channel).get(position)?))
    };
    accepted(calibration, place).filter_map(of_draw).collect()
}

/// Returns the variance of one measurement of a run: noise plus the errors that runs share.
fn noise_variance(calibration: &FinishedCalibration, run: usize, channel: Channel, noise_sd: f64) -> f64 {
    let sd = calibration.spec.experiment.runs[run].sd[channel.index()].unwrap_or(noise_sd);
    let place = RunPosition::find(&calibration.spec, run);
    let draws = place.into_iter().flat_map(|place| accepted(calibration, place));
    let squares: Vec<f64> = draws
        .map(|(_, theta, observables, position)| {
            let soil = shared_error(calibration, run, channel, (theta, observables, position));
            soil * soil
        })
        .collect();
    sd * sd + mean(&squares).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::table::row::ComparisonRow;

    fn row<'a>(calibration: &'a FinishedCalibration, run: &str) -> &'a ComparisonRow {
        let mut rows = calibration.comparison().rows.iter();
        rows.find(|row| row.run == run && row.channel == Channel::DrawbarPull)
            .unwrap()
    }

    #[test]
    fn a_misfit_that_follows_slip_is_corrected_between_the_fitted_runs() {
        let calibration = fixture::with_smooth_misfit();
        let h1 = row(&calibration, "h1");
        let (before, after) = (
            h1.measured - h1.predicted.unwrap(),
            h1.measured - h1.corrected.unwrap(),
        );
        assert!(
            before.abs() > 2.0 && after.abs() < 0.2 * before.abs(),
            "{before} {after}"
        );
        assert_eq!(h1.covered_corrected(), Some(true));
        let comparison = calibration.comparison();
        let [fit, corrected] = [&comparison.fit, &comparison.corrected_fit]
            .map(|table| table.as_ref().unwrap().drawbar_pull.unwrap().rmse);
        // Each fitted run is predicted from the others, including the extrapolation at the ends of the range.
        assert!(corrected < 0.5 * fit, "{corrected} {fit}");
    }

    #[test]
    fn what_a_draw_moves_everywhere_alike_is_taken_back() {
        let calibration = fixture::with_smooth_misfit();
        let run = fixture::position(&calibration, "h1");
        let correction = Correction::new(&calibration, Channel::DrawbarPull, 1.0, Basis::Model).unwrap();
        let discrepancy = correction.process.at(
            &correction
                .conditions
                .point(&calibration.spec.experiment.runs[run]),
            0,
        );
        let (shift, spread) = correction.paired(&calibration, run, &discrepancy);
        let alone = values(&calibration, run, Channel::DrawbarPull).into_values();
        let (_, sd) = mean_and_sd(&alone.collect::<Vec<f64>>()).unwrap();
        assert!(sd > 0.9 && spread < 0.5 * sd, "{spread} {sd}");
        assert!(shift.abs() < 1e-12, "{shift}");
    }

    #[test]
    fn draws_that_refuse_a_run_do_not_move_what_is_predicted_of_it() {
        let whole = fixture::with_smooth_misfit();
        let mut fewer = fixture::with_smooth_misfit();
        // The holdout runs reject half of the draws that lie 1 N too low; the remaining draws are 1/3 N too high on average.
        for prediction in fewer.predictions.iter_mut().skip(1).step_by(4) {
            if let Some(held_out) = &mut prediction.holdout {
                held_out.together = Err(record::RejectionReason("no balance".to_owned()));
            }
        }
        let predictions = |calibration: &FinishedCalibration| {
            let row = row(calibration, "h1");
            (row.predicted.unwrap(), row.corrected.unwrap())
        };
        let (predicted, corrected) = predictions(&whole);
        let (moved, paired) = predictions(&fewer);
        assert!(
            (moved - predicted - 1.0 / 3.0).abs() < 0.05,
            "{moved} {predicted}"
        );
        assert!((paired - corrected).abs() < 0.15, "{paired} {corrected}");
    }

    #[test]
    fn a_run_beside_the_one_speed_of_the_fitted_runs_is_not_corrected_and_says_why() {
        let calibration = fixture::with_smooth_misfit();
        assert_eq!(row(&calibration, "fast").corrected, None);
        assert_eq!(
            calibration.comparison().not_corrected,
            [
                "drawbar pull was fitted at one sled speed alone",
                "sinkage was fitted at one sled speed alone"
            ]
        );
        let few = fixture::calibration();
        assert!(few.comparison().corrected_holdout.is_none());
        assert!(
            few.comparison().not_corrected[0]
                .contains("has 3 fitted conditions, and a discrepancy over slip needs 4"),
            "{:?}",
            few.comparison().not_corrected
        );
    }
}
