//! Predictions by the fitted measurements alone, without a model.

use std::collections::BTreeMap;

use shared::channel::Channel;

use super::corrected::Corrected;
use super::correction::{Basis, Correction};
use super::fixed_sigma::FixedSigmas;
use crate::finished_calibration::FinishedCalibration;

/// The prediction of each channel by its fitted measurements: their mean, a plane and a process over the conditions, as a model is corrected
/// ([`inference::discrepancy::DiscrepancyProcess::about_a_plane`]). A channel that cannot be corrected has none.
#[derive(Debug)]
pub(super) struct WithoutModel<'a> {
    calibration: &'a FinishedCalibration,
    channels: BTreeMap<Channel, Correction>,
}

impl<'a> WithoutModel<'a> {
    /// Infers the process of each channel.
    ///
    /// # Arguments
    /// - `calibration`: a calibration on the measurements, for their noise and the errors that runs share.
    pub(super) fn new(calibration: &'a FinishedCalibration) -> Self {
        let sigmas = FixedSigmas::new(calibration);
        let process = |channel: Channel| {
            let correction = Correction::new(calibration, channel, sigmas.get(channel)?.sd, Basis::Mean);
            Some((channel, correction.ok()?))
        };
        WithoutModel {
            calibration,
            channels: Channel::ALL.into_iter().filter_map(process).collect(),
        }
    }

    /// Returns the prediction of a run, by its position in the experiment; of a fitted run by the other conditions.
    pub(super) fn at(&self, run: usize, channel: Channel) -> Option<Corrected> {
        let process = self.channels.get(&channel)?;
        process.at(self.calibration, run, (process.mean, true)).ok()
    }

    /// Returns the root mean square error of the fitted runs [channel's unit], each predicted without its level of a condition; without its
    /// condition where no condition has levels.
    pub(super) fn rmse(&self, channel: Channel) -> Option<f64> {
        let process = self.channels.get(&channel)?;
        let spec = &self.calibration.spec;
        let mut predicted: Vec<(usize, f64)> = process
            .between_levels()
            .into_iter()
            .map(|(run, discrepancy)| (run, process.mean + discrepancy))
            .collect();
        if predicted.is_empty() {
            let of_run = |&run: &usize| Some((run, self.at(run, channel)?.mean));
            predicted = spec.fit_runs.iter().filter_map(of_run).collect();
        }
        let error = |&(run, predicted): &(usize, f64)| {
            Some(spec.experiment.runs[run].measured[channel.index()]? - predicted)
        };
        let squares: Vec<f64> = predicted
            .iter()
            .filter_map(error)
            .map(|error| error * error)
            .collect();
        inference::diagnostics::mean(&squares).map(f64::sqrt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn measurements_that_follow_a_plane_are_predicted_without_a_model() {
        // The measured pull is 10 times the slip.
        let calibration = fixture::with_smooth_misfit();
        let alone = WithoutModel::new(&calibration);
        let run = fixture::position(&calibration, "h1");
        let predicted = alone.at(run, Channel::DrawbarPull).unwrap();
        let measured = calibration.spec.experiment.runs[run].measured[Channel::DrawbarPull.index()].unwrap();
        assert!(
            (predicted.mean - measured).abs() < 0.1,
            "{predicted:?} {measured}"
        );
        let [q05, q95] = predicted.interval.unwrap();
        assert!(q05 < measured && measured < q95);
        assert!(alone.rmse(Channel::DrawbarPull).unwrap() < 0.3);
        assert_eq!(alone.rmse(Channel::Torque), None);
        let beside = fixture::position(&calibration, "fast");
        assert_eq!(alone.at(beside, Channel::DrawbarPull), None, "at one speed alone");
    }
}
