//! The training points of the sampler's emulators, and the fit of an emulator to them.

use super::emulator::{Emulator, EmulatorCoordinates, Frame, TrainingPoint};
use super::round::Outputs;
use super::sampler::EmulatedSampler;
use crate::round::Proposal;

impl EmulatedSampler {
    /// Adds evaluations to the training points.
    pub(super) fn learn(&mut self, proposals: &[Proposal], outputs: &[Outputs]) {
        for (proposal, outputs) in proposals.iter().zip(outputs) {
            let coordinates = EmulatorCoordinates::ALL
                .map(|kind| kind.coordinates(&self.prior, &proposal.theta, self.model_parameters));
            self.training.push(TrainingPoint {
                coordinates,
                outputs: outputs.clone(),
            });
        }
    }

    /// Fits an emulator in the frame of parameter vectors, in the coordinates in which it predicts better.
    pub(super) fn emulator(&mut self, thetas: &[&[f64]]) -> Option<Emulator> {
        let scales = self.scales(thetas);
        let mut best: Option<Emulator> = None;
        for kind in EmulatorCoordinates::ALL {
            let rows: Vec<Vec<f64>> = thetas
                .iter()
                .map(|theta| kind.coordinates(&self.prior, theta, self.model_parameters))
                .collect();
            let Some(frame) = Frame::new(rows.iter().map(Vec::as_slice)) else {
                continue;
            };
            let before = self.hyperparameters[kind as usize];
            let fitted = Emulator::fit(&self.training, (kind, frame), scales.clone(), before);
            self.hyperparameters[kind as usize] = fitted.as_ref().map(Emulator::settings);
            let Some(mut fitted) = fitted else { continue };
            fitted.is_rough = self.is_rough;
            if best
                .as_ref()
                .is_none_or(|best| fitted.left_out_error < best.left_out_error)
            {
                best = Some(fitted);
            }
        }
        best
    }

    /// Returns the unit of each output: the error sd of a datum, averaged over parameter vectors; of a derivative, a part of
    /// its spread.
    fn scales(&self, thetas: &[&[f64]]) -> Vec<f64> {
        let data = self.likelihood.data().iter().map(|datum| {
            let logarithms = thetas.iter().map(|theta| libm::log(datum.sd.at(theta)));
            libm::exp(logarithms.sum::<f64>() / thetas.len() as f64)
        });
        let mut scales: Vec<f64> = data.collect();
        for place in scales.len()..self.likelihood.values() {
            let values: Vec<f64> = self
                .training
                .iter()
                .filter_map(|p| Some(p.outputs.as_ref()?[place]))
                .collect();
            let spread = crate::diagnostics::mean_and_sd(&values).map_or(1.0, |(_, sd)| 0.05 * sd);
            scales.push(if spread > 0.0 { spread } else { 1.0 });
        }
        scales
    }
}
