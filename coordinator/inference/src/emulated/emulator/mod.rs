//! The emulator: a fast approximation of the model's outputs near the present target.
//!
//! The outputs of nearby training points are represented in a small basis, in units of their error sds, and each component is
//! fitted by a polynomial trend with a kriged remainder in coordinates in which the target is white. The hyperparameters are
//! those whose predictions of each point from all other points are best.
//!
//! # Layout
//! - `training`: the training points. `frame`: the whitened coordinates. `output_basis`: the components of the outputs.
//! - `trend`, `kriging`: the fit of the components. `acceptance`: the probability that the model accepts a point.

mod acceptance;
mod coordinates;
mod frame;
mod kriging;
mod output_basis;
mod training;
mod trend;

pub use coordinates::EmulatorCoordinates;
pub(crate) use frame::Frame;
pub(crate) use training::TrainingPoint;

pub use kriging::KrigingSettings;
pub use trend::TrendDegree;

use statistics::prior::Prior;

use acceptance::Acceptance;
use kriging::Kriging;
use output_basis::OutputBasis;

/// Correlation lengths that are compared, in sds of the target.
const LENGTHS: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];

/// Nuggets that are compared.
const NUGGETS: [f64; 5] = [1e-9, 1e-7, 1e-5, 1e-3, 1e-1];

/// Smallest weight of the error of a training point.
const MIN_WEIGHT: f64 = 1e-9;

/// A prediction of an emulator.
pub(crate) struct Prediction {
    pub(crate) outputs: Vec<f64>,
    /// Sd of the prediction of an output, in error sds.
    pub(crate) sd: f64,
    /// Probability that the model accepts the parameters.
    pub(crate) acceptance: f64,
}

/// An emulator of the model's outputs.
#[derive(Debug, Clone)]
pub(crate) struct Emulator {
    /// Whether the scatter of the outputs about their smooth part is part of the error model.
    pub(crate) is_rough: bool,
    pub(crate) kind: EmulatorCoordinates,
    frame: Frame,
    basis: OutputBasis,
    kriging: Kriging,
    acceptance: Option<Acceptance>,
    /// Number of outputs.
    output_count: f64,
    /// Root mean square error of the predictions of a point from all other points, in error sds of one output.
    pub(crate) left_out_error: f64,
    dimension: usize,
    /// Number of training points.
    pub(crate) points: usize,
}

impl Emulator {
    /// Fits an emulator; `None` where the points do not determine one.
    ///
    /// # Arguments
    /// - `frame`: the coordinates, and the frame of the target in them.
    /// - `scales`: the unit of each output, > 0: the sd of its error.
    /// - `before`: the hyperparameters of the last fit; their neighbours are compared, and all if there are none.
    pub(crate) fn fit(
        training: &[TrainingPoint],
        (kind, frame): (EmulatorCoordinates, Frame),
        scales: Vec<f64>,
        before: Option<KrigingSettings>,
    ) -> Option<Self> {
        let dimension = training.first()?.coordinates[kind as usize].len();
        let near = training::near(training, kind, &frame, TrendDegree::Quadratic.terms(dimension));
        let accepted: Vec<_> = near.iter().filter(|point| point.outputs.is_some()).collect();
        let outputs: Vec<&[f64]> = accepted.iter().filter_map(|point| point.outputs).collect();
        let count = scales.len() as f64;
        let basis = OutputBasis::new(&outputs, scales);
        let points: Vec<Vec<f64>> = accepted.iter().map(|point| point.u.clone()).collect();
        let values: Vec<Vec<f64>> = outputs.iter().map(|y| basis.components(y)).collect();
        // Errors count where the target has its mass.
        let weights: Vec<f64> = accepted
            .iter()
            .map(|point| libm::exp(-0.5 * point.square / dimension as f64).max(MIN_WEIGHT))
            .collect();
        let (error, kriging) = best_fit(&points, &values, &weights, before)?;
        let judged = near
            .iter()
            .map(|point| (point.u.clone(), point.outputs.is_some()));
        Some(Self {
            acceptance: Acceptance::new(judged.collect()),
            left_out_error: (error / count).sqrt(),
            points: points.len(),
            output_count: count,
            is_rough: false,
            kind,
            dimension,
            frame,
            basis,
            kriging,
        })
    }

    /// Predicts the outputs at a parameter vector.
    pub(crate) fn predict(&self, prior: &Prior, theta: &[f64]) -> Prediction {
        let u = self
            .frame
            .whiten(&self.kind.coordinates(prior, theta, self.dimension));
        let predicted = self.kriging.predict(&u);
        // The scatter of a rough model was measured; that of a smooth one is an error of the emulator.
        let unknown_scatter = if self.is_rough {
            0.0
        } else {
            self.settings().nugget
        };
        Prediction {
            sd: (predicted.remainder_variance / self.output_count
                * (predicted.smooth_variance + unknown_scatter))
                .sqrt(),
            outputs: self.basis.outputs(&predicted.components),
            acceptance: self.acceptance.as_ref().map_or(1.0, |a| a.probability(&u)),
        }
    }

    /// Returns the hyperparameters.
    pub(crate) fn settings(&self) -> KrigingSettings {
        self.kriging.settings
    }
}

/// Returns the fit with the smallest error of left-out points, and that error.
fn best_fit(
    points: &[Vec<f64>],
    values: &[Vec<f64>],
    weights: &[f64],
    before: Option<KrigingSettings>,
) -> Option<(f64, Kriging)> {
    let mut best: Option<(f64, Kriging)> = None;
    for settings in compared(before) {
        if let Some(fit) = Kriging::new(points, values, weights, settings) {
            let error = fit.left_out_error(weights);
            if error.is_finite() && best.as_ref().is_none_or(|(smallest, _)| error < *smallest) {
                best = Some((error, fit));
            }
        }
    }
    best
}

/// Returns the hyperparameters that are compared: all, or those before with their neighbours.
fn compared(before: Option<KrigingSettings>) -> Vec<KrigingSettings> {
    let mut compared = Vec::new();
    let place = |grid: &[f64], value: f64| grid.iter().position(|x| x.to_bits() == value.to_bits());
    let steps = before.map(|s| (place(&LENGTHS, s.length), place(&NUGGETS, s.nugget)));
    for degree in [TrendDegree::Quadratic, TrendDegree::Linear] {
        for (i, &length) in LENGTHS.iter().enumerate() {
            for (j, &nugget) in NUGGETS.iter().enumerate() {
                let near = match steps {
                    Some((Some(l), Some(n))) => {
                        i.abs_diff(l) + j.abs_diff(n) <= 1
                            && (before.is_some_and(|s| s.degree == degree)
                                || i.abs_diff(l) + j.abs_diff(n) == 0)
                    }
                    _ => true,
                };
                if near {
                    compared.push(KrigingSettings {
                        degree,
                        length,
                        nugget,
                    });
                }
            }
        }
    }
    compared
}
