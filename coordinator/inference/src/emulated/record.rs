//! The record of an emulator: what each batch of evaluations said about it.

use serde::{Deserialize, Serialize};

use super::emulator::{EmulatorCoordinates, KrigingSettings};

/// A batch of evaluations at draws of the emulated target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EmulatorRound {
    /// Tempering exponent of the target.
    pub tempering_exponent: f64,
    /// Number of evaluations of the batch.
    pub evaluations: usize,
    /// Number of evaluations that the model rejected.
    pub rejected: usize,
    /// Number of explored vectors that belong to the target, although the emulator did not trust its prediction there.
    pub missed: usize,
    /// Mean and sd over the batch of the error of the tempered log-likelihood, in nats; `None` where the model rejected all of it.
    pub error: Option<[f64; 2]>,
    /// Root mean square error of the outputs of each channel by its index, in error sds.
    pub channel_errors: Vec<f64>,
    /// Number of training points of the emulator.
    pub training_points: usize,
    /// Coordinates of the emulator.
    pub coordinates: EmulatorCoordinates,
    /// Hyperparameters of the emulator.
    pub settings: KrigingSettings,
    /// Root mean square error of predictions of a training point from all other points, in error sds.
    pub left_out_error: f64,
    /// Whether the emulator agreed with the model, so that the exponent grew.
    pub agreed: bool,
}

/// The weights of the final draws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FinalWeights {
    /// Number of final draws.
    pub draws: usize,
    /// Effective sample size of the draws.
    pub ess: f64,
    /// Largest share of one draw.
    pub max_share: f64,
}

/// What the rounds of an emulated sampler found.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EmulatorRecord {
    /// The batches, in their order.
    pub rounds: Vec<EmulatorRound>,
    /// The final draws, in their order: only the last one is the result.
    pub finals: Vec<FinalWeights>,
    /// Sd of the model's scatter by channel that the error model includes, in the unit of the channel; empty for a smooth model.
    pub numerical_noise: Vec<f64>,
    /// Whether the emulator was given up, so that the model itself was sampled by draws and moves.
    pub fell_back: bool,
}
