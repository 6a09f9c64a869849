//! The draws of a response surface: the coordinates of the posterior, and the distinct draws of a run with their outputs.

use std::collections::BTreeSet;

use inference::diagnostics;
use inference::response_surface::{ResponseSurfaceError, Whitening};
use shared::channel::Channel;

use super::parameter::SurfaceParameter;
use crate::finished_calibration::FinishedCalibration;
use crate::table::predictive::{RunPosition, accepted};

/// Quantile of the distances of the draws that is the radius.
const RADIUS_QUANTILE: f64 = 0.99;

/// The whitened coordinates of a posterior.
#[derive(Debug)]
pub(super) struct PosteriorCoordinates {
    /// Parameters of the model in the order of the coordinates. Parameters that the model does not take, such as the noise, are not among
    /// them.
    pub parameters: Vec<SurfaceParameter>,
    /// Position of each of them in a parameter vector.
    positions: Vec<usize>,
    /// Mean and covariance of the coordinates.
    pub whitening: Whitening,
    /// Distance from the mean within which 99 % of the draws lie.
    pub radius: f64,
}

impl PosteriorCoordinates {
    /// Computes the coordinates of a calibration's draws.
    ///
    /// # Errors
    /// [`ResponseSurfaceError`] if there are too few draws, or if they do not vary independently in every parameter.
    pub(super) fn new(calibration: &FinishedCalibration) -> Result<Self, ResponseSurfaceError> {
        let spec = &calibration.spec;
        let is_of_model = |name: &String| spec.fit_variant.parameters.contains(name);
        let positions: Vec<usize> = (0..spec.parameters.len())
            .filter(|&i| is_of_model(&spec.parameters[i].name))
            .collect();
        let mut parameters: Vec<SurfaceParameter> = positions
            .iter()
            .filter_map(|&i| SurfaceParameter::new(&spec.parameters[i], &calibration.draws(i)))
            .collect();
        let draws: Vec<Vec<f64>> = calibration
            .posterior()
            .iter()
            .map(|draw| unscaled(&parameters, &positions, &draw.theta))
            .collect();
        let whitening = Whitening::new(&draws)?;
        for (parameter, centre) in parameters.iter_mut().zip(whitening.mean()) {
            parameter.centre = *centre;
        }
        let distance = |draw: &Vec<f64>| whitening.whitened(draw).iter().map(|u| u * u).sum::<f64>().sqrt();
        let distances: Vec<f64> = draws.iter().map(distance).collect();
        Ok(PosteriorCoordinates {
            radius: diagnostics::quantile(&distances, RADIUS_QUANTILE).unwrap_or_default(),
            parameters,
            positions,
            whitening,
        })
    }

    /// Returns the whitened coordinates of a parameter vector.
    pub(super) fn whitened(&self, theta: &[f64]) -> Vec<f64> {
        let unscaled = unscaled(&self.parameters, &self.positions, theta);
        self.whitening.whitened(&unscaled)
    }
}

/// Returns the coordinates of a parameter vector before whitening.
fn unscaled(parameters: &[SurfaceParameter], positions: &[usize], theta: &[f64]) -> Vec<f64> {
    let pairs = parameters.iter().zip(positions);
    pairs
        .map(|(parameter, &position)| parameter.coordinate(theta[position]))
        .collect()
}

/// Returns the numbers of the distinct final draws, in ascending order. Equal draws have equal outputs, so that a repeated draw would hide
/// its own error when it is left out.
pub(super) fn distinct_draws(calibration: &FinishedCalibration) -> Vec<usize> {
    let mut seen: BTreeSet<Vec<u64>> = BTreeSet::new();
    let draws = calibration.predictive_draws().iter().enumerate();
    draws
        .filter(|(_, draw)| seen.insert(draw.theta.iter().map(|x| x.to_bits()).collect()))
        .map(|(number, _)| number)
        .collect()
}

/// Returns those of the given draws at which the model accepts a run.
pub(super) fn accepted_draws(calibration: &FinishedCalibration, run: usize, draws: &[usize]) -> Vec<usize> {
    let Some(place) = RunPosition::find(&calibration.spec, run) else {
        return Vec::new();
    };
    accepted(calibration, place)
        .map(|(number, ..)| number)
        .filter(|number| draws.binary_search(number).is_ok())
        .collect()
}

/// Returns the values of a run and channel at the given draws; `None` if the model does not predict the channel.
pub(super) fn outputs(
    calibration: &FinishedCalibration,
    (run, channel): (usize, Channel),
    draws: &[usize],
) -> Option<Vec<f64>> {
    let place = RunPosition::find(&calibration.spec, run)?;
    accepted(calibration, place)
        .filter(|(number, ..)| draws.binary_search(number).is_ok())
        .map(|(_, _, observables, position)| observables.channel(channel).get(position).copied())
        .collect()
}
