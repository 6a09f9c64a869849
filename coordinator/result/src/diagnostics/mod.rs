//! Diagnostics: statistics that show how far a calibration can be trusted, and where its model fails.
//!
//! # Layout
//! - `calibration`: all diagnostics of a calibration, as one value.
//! - `sampler`: stages, equilibrium, effective sample size.
//! - `emulator`: errors of an emulator, weights of its final draws.
//! - `channels`: information of each channel, its misfit, coverage of its intervals.
//! - `residuals`: fitted measurements minus predictions. `trends`: tests whether residuals follow a condition of the runs.
//! - `parameters`: contraction, bounds, conflict with the prior. `directions`: combinations of parameters.
//! - `rejections`: rejections and faults by region of the prior.
//! - `verification`: how many results a second worker confirmed.
//! - `data_channel`: the channel and run of each datum of the likelihood.
//!
//! The statistics come from [`inference::diagnostics`]. Only the coverage of holdout rows reads holdout rows, and no decision depends
//! on it.

pub mod calibration;
pub mod channels;
pub mod data_channel;
pub mod directions;
pub mod emulator;
pub mod parameters;
pub mod rejections;
pub mod residuals;
pub mod sampler;
pub mod trends;
pub mod verification;

pub use calibration::Diagnostics;
pub use channels::{ChannelDiagnostics, ChiSquareTest, CoverageCount};
pub use directions::{DirectionDiagnostics, Loading};
pub use emulator::{EmulatorDiagnostics, EmulatorRoundRow};
pub use parameters::{ParameterDiagnostics, PriorConflict};
pub use rejections::{BinnedParameter, PriorBin, PriorRegion, RegionSide, RejectionDiagnostics};
pub use residuals::ResidualDiagnostics;
pub use sampler::SamplerDiagnostics;
pub use trends::{TrendDiagnostics, TrendVariable};
pub use verification::VerificationDiagnostics;

use inference::diagnostics::PredictedDraw;

use crate::finished_calibration::FinishedCalibration;

/// Returns the final draws, each with its predictions of the fitted data.
pub fn posterior_draws(calibration: &FinishedCalibration) -> Vec<PredictedDraw> {
    let draws = calibration.predictive_draws().iter();
    let predicted = draws.filter_map(|draw| {
        Some(PredictedDraw {
            theta: draw.theta.clone(),
            values: calibration.spec.predicted_values(draw.fit.as_ref().ok()?),
        })
    });
    predicted.collect()
}
