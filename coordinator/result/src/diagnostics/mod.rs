//! Diagnostics of a calibration.
//!
//! # Layout
//! - `calibration`: all of them.
//! - `sampler`: stages, equilibrium, effective sample size.
//! - `channels`: information of each channel, its misfit, coverage of its intervals.
//! - `residuals`: every fitted measurement beside its prediction. `trends`: whether they follow a condition of the runs.
//! - `parameters`: contraction, bounds, conflict with the prior. `directions`: combinations of parameters.
//! - `rejections`: rejections and faults by region of the prior.
//! - `verification`: how many results a second worker has computed as well.
//! - `data_channel`: channels and runs of the fitted data.
//!
//! The statistics are [`inference::diagnostics`]'s. Nothing here but the coverage of holdout rows, which decides nothing,
//! reads a holdout row.

pub mod calibration;
pub mod channels;
pub mod data_channel;
pub mod directions;
pub mod parameters;
pub mod rejections;
pub mod residuals;
pub mod sampler;
pub mod trends;
pub mod verification;

pub use calibration::Diagnostics;
pub use channels::{ChannelDiagnostics, ChiSquareTest, CoverageCount};
pub use directions::{DirectionDiagnostics, Loading};
pub use parameters::{ParameterDiagnostics, PriorConflict};
pub use rejections::{BinnedParameter, PriorBin, PriorRegion, RegionSide, RejectionDiagnostics};
pub use residuals::ResidualDiagnostics;
pub use sampler::SamplerDiagnostics;
pub use trends::{TrendDiagnostics, TrendVariable};
pub use verification::VerificationDiagnostics;

use inference::diagnostics::PredictedDraw;

use crate::finished_calibration::FinishedCalibration;

/// The final draws with the values that the likelihood takes.
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
