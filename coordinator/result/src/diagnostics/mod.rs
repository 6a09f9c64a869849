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

pub(crate) mod calibration;
pub(crate) mod channels;
pub(crate) mod data_channel;
pub(crate) mod directions;
pub(crate) mod parameters;
pub(crate) mod rejections;
pub(crate) mod residuals;
pub(crate) mod sampler;
pub(crate) mod trends;
pub(crate) mod verification;

pub use calibration::Diagnostics;
pub use channels::{ChannelDiagnostics, ChiSquareTest, CoverageCount};
pub use directions::{DirectionDiagnostics, Loading};
pub use parameters::{ParameterDiagnostics, PriorConflict};
pub use rejections::{BinnedParameter, PriorBin, PriorRegion, RegionSide, RejectionDiagnostics};
pub use residuals::ResidualDiagnostics;
pub use sampler::SamplerDiagnostics;
pub use trends::{TrendDiagnostics, TrendVariable};
pub use verification::VerificationDiagnostics;
