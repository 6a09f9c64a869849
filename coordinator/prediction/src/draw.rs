//! Values of a planned run at each draw of each model, with errors of new measurements.

use std::f64::consts::TAU;

use result::{Component, FinishedCalibration, NewMeasurements};
use shared::channel::Channel;
use statistics::ErrorLaw;
use statistics::rng::Stream;

use crate::ensemble::Simulated;

/// Errors of a new measurement that are drawn for each draw.
pub const ERRORS: usize = 10;
/// The first random stream of predictions, which no sampler uses.
const STAGE: u64 = 1 << 44;

/// A planned run at one draw of one model.
#[derive(Debug, Clone)]
pub struct DrawnRun {
    /// The model's values by channel; NaN of a channel that it does not predict.
    pub values: [f64; 4],
    /// Errors by channel, [`ERRORS`] of them; 0 where the noise of a channel is unknown.
    pub errors: Vec<[f64; 4]>,
    /// Root mean square of the errors' scale by channel; `None` where the noise is unknown.
    pub scales: [Option<f64>; 4],
}

impl DrawnRun {
    /// Returns the channels of a new measurement.
    pub fn measured(&self, error: usize) -> [f64; 4] {
        std::array::from_fn(|c| self.values[c] + self.errors[error][c])
    }
}

/// A draw of a model: a member of the weighted sample that predictions and decisions are computed from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedDraw {
    /// Position of the model.
    pub model: usize,
    /// Number of the draw among those of the model.
    pub draw: usize,
    /// Weight of the model over its number of draws.
    pub weight: f64,
}

/// The draws of all models under the planned runs.
pub struct Draws<'a> {
    simulated: &'a Simulated,
    measurements: Vec<NewMeasurements<'a>>,
    /// All draws: the first model's first.
    pub all: Vec<WeightedDraw>,
}

impl<'a> Draws<'a> {
    /// Prepares the draws of simulated models.
    pub fn new(simulated: &'a Simulated) -> Self {
        let models = simulated.models.iter().enumerate();
        let draws = models.flat_map(|(model, weighted)| {
            let count = weighted.calibration.predictive_draws().len();
            let weight = weighted.weight / count as f64;
            (0..count).map(move |draw| WeightedDraw { model, draw, weight })
        });
        Draws {
            all: draws.collect(),
            measurements: simulated
                .models
                .iter()
                .map(|model| NewMeasurements::new(&model.calibration))
                .collect(),
            simulated,
        }
    }

    /// Returns a planned run at every draw, in the order of [`Draws::all`]; `None` where the model refuses it.
    ///
    /// The errors of a channel are independent of those of other channels. Runs with the same number of errors differ by the sizes of
    /// their errors alone, so that a curve of them is smooth.
    ///
    /// # Arguments
    /// - `run`: position of the planned run. `errors`: number of the errors.
    pub fn of_run(&self, run: usize, errors: usize) -> Vec<Option<DrawnRun>> {
        let position = self.simulated.first + run;
        let mut drawn = Vec::with_capacity(self.all.len());
        for (model, new) in self.simulated.models.iter().zip(&self.measurements) {
            let calibration = &model.calibration;
            let count = calibration.predictive_draws().len();
            let mut of_model: Vec<Option<DrawnRun>> = vec![None; count];
            for channel in Channel::ALL {
                for new_measurement in new.at(position, channel) {
                    let blank = || DrawnRun {
                        values: [f64::NAN; 4],
                        errors: vec![[0.0; 4]; ERRORS],
                        scales: [None; 4],
                    };
                    let draw = new_measurement.draw;
                    let place = of_model[draw].get_or_insert_with(blank);
                    let c = channel.index();
                    let components = &new_measurement.components;
                    place.values[c] = components.first().map_or(f64::NAN, |component| component.mean);
                    place.scales[c] = scale(components);
                    let number = drawn.len() + draw;
                    let streams = Errors {
                        seed: calibration.spec.algorithm.seed(),
                        stage: STAGE + errors as u64,
                        draw: number as u64,
                    };
                    streams.add(components, calibration, &mut place.errors, c);
                }
            }
            drawn.extend(of_model);
        }
        drawn
    }

    /// Returns a planned run at the most probable parameters of the model that was asked for; NaN where it refuses them.
    pub fn at_mode(&self, run: usize) -> [f64; 4] {
        let calibration = &self.simulated.models[0].calibration;
        let mode = calibration
            .predictions
            .first()
            .and_then(|mode| mode.holdout.as_ref());
        match mode.map(|holdout| holdout.run(run)) {
            Some(Ok((observables, at))) => Channel::ALL.map(|channel| {
                let value = observables.channel(channel).get(at);
                value.copied().unwrap_or(f64::NAN)
            }),
            _ => [f64::NAN; 4],
        }
    }
}

/// Returns the root mean square of the scales; `None` if one of them is unknown.
fn scale(components: &[Component]) -> Option<f64> {
    let mut sum = [0.0; 2];
    for component in components {
        sum[0] += component.weight * component.scale?.powi(2);
        sum[1] += component.weight;
    }
    (sum[1] > 0.0).then(|| (sum[0] / sum[1]).sqrt())
}

/// The random streams of one draw.
struct Errors {
    seed: u64,
    stage: u64,
    draw: u64,
}

impl Errors {
    /// Draws the errors of a channel.
    fn add(
        &self,
        components: &[Component],
        calibration: &FinishedCalibration,
        errors: &mut [[f64; 4]],
        channel: usize,
    ) {
        let law = calibration.spec.likelihood.law();
        for (number, error) in errors.iter_mut().enumerate() {
            let step = (4 * number + channel) as u64;
            let mut stream = Stream::new(self.seed, self.stage, self.draw, step);
            let chosen = chosen(components, stream.uniform());
            let standard = standard_error(&mut stream, law);
            error[channel] = chosen.and_then(|component| component.scale).unwrap_or(0.0) * standard;
        }
    }
}

/// Returns the component at a share of the weights.
fn chosen(components: &[Component], share: f64) -> Option<&Component> {
    let total: f64 = components.iter().map(|component| component.weight).sum();
    let mut left = share * total;
    let at = components.iter().find(|component| {
        left -= component.weight;
        left < 0.0
    });
    at.or(components.last())
}

/// Draws an error in units of its scale.
///
/// # Source
/// Student's t: Bailey 1994, Math. Comp. 62:779, doi:10.2307/2153537. Checked by `tests::errors_have_the_spread_of_their_law`.
fn standard_error(stream: &mut Stream, law: ErrorLaw) -> f64 {
    match law {
        ErrorLaw::Gaussian => stream.normal_pair().0,
        ErrorLaw::StudentT { degrees_of_freedom } => {
            let power = libm::pow(stream.uniform(), -2.0 / degrees_of_freedom);
            (degrees_of_freedom * (power - 1.0)).sqrt() * libm::cos(TAU * stream.uniform())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_the_spread_of_their_law() {
        let mut stream = Stream::new(1, 2, 3, 4);
        let share = |law, within: f64, stream: &mut Stream| {
            let inside = (0..20_000).filter(|_| standard_error(stream, law).abs() < within);
            inside.count() as f64 / 20_000.0
        };
        assert!((share(ErrorLaw::Gaussian, 1.644_854, &mut stream) - 0.9).abs() < 0.01);
        let heavy = ErrorLaw::StudentT {
            degrees_of_freedom: 3.0,
        };
        // Abramowitz & Stegun, table 26.10.
        assert!((share(heavy, 2.353_363, &mut stream) - 0.9).abs() < 0.01);
    }

    #[test]
    fn a_component_is_chosen_by_its_weight() {
        let component = |mean, weight| Component {
            mean,
            scale: Some(1.0),
            weight,
        };
        let both = [component(1.0, 0.25), component(2.0, 0.75)];
        assert!((chosen(&both, 0.2).unwrap().mean - 1.0).abs() < 1e-15);
        assert!((chosen(&both, 0.3).unwrap().mean - 2.0).abs() < 1e-15);
        assert!((scale(&both).unwrap() - 1.0).abs() < 1e-12);
        assert!(chosen(&[], 0.3).is_none());
    }
}
