//! The rounds of an emulated sampler, with what each must remember until its evaluations are told.

use super::batch::Batch;
use super::sample::EmulatedSample;
use crate::tmcmc::{PosteriorSample, Sampler};

/// Outputs of an evaluation; `None` where the model rejected the parameters.
pub(super) type Outputs = Option<Vec<f64>>;

/// The pending evaluations.
#[derive(Debug, Clone)]
pub(super) enum EmulatedRound {
    /// Points spread over the prior.
    Design,
    /// Draws of the emulated target of a stage.
    Refinement(Box<Refinement>),
    /// Lines that measure the scatter of the model.
    Scatter(Box<ScatterLines>),
    /// The final draws.
    Final(Box<FinalBatch>),
    /// Rounds of the sampler that evaluates the model at each draw.
    Fallback(Box<Sampler>),
}

/// The next round of a sampler, with its parameter vectors, or its end.
pub(super) enum Next {
    /// A round at these parameter vectors.
    Ask(EmulatedRound, Vec<Vec<f64>>),
    /// The result.
    Done(Box<PosteriorSample>),
    /// The emulator is given up.
    GiveUp,
}

/// A round of a stage.
#[derive(Debug, Clone)]
pub(super) struct Refinement {
    pub(super) position: Position,
    /// The sample of the emulated target.
    pub(super) sample: EmulatedSample,
    pub(super) batch: Batch,
}

/// The place of a round in the sequence of stages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Position {
    /// Exponent of the last stage.
    pub(super) from: f64,
    pub(super) exponent: f64,
    /// Number of rounds and evaluations of this stage before this round.
    pub(super) rounds: usize,
    pub(super) evaluations: usize,
    /// Share of the effective draws of the last sample at this exponent.
    pub(super) share: f64,
}

/// Lines of evaluations in a stage that is repeated.
#[derive(Debug, Clone)]
pub(super) struct ScatterLines {
    pub(super) position: Position,
    pub(super) sample: EmulatedSample,
}

/// The final draws that await their evaluation.
#[derive(Debug, Clone)]
pub(super) struct FinalBatch {
    /// The sample of the emulated posterior that led here.
    pub(super) sample: EmulatedSample,
    /// The draws, those of one density after the other.
    pub(super) thetas: Vec<Vec<f64>>,
    /// ln (density of the draws / prior density), and the emulated posterior's density over that of the draws.
    pub(super) densities: Vec<(f64, f64)>,
    /// Variance of the log-evidence of the emulated posterior.
    pub(super) variance: f64,
}
