//! All diagnostics of a calibration.

use super::channels::{ChannelDiagnostics, ChiSquareTest};
use super::directions::DirectionDiagnostics;
use super::parameters::{ParameterDiagnostics, PriorConflict};
use super::rejections::RejectionDiagnostics;
use super::residuals::ResidualDiagnostics;
use super::sampler::SamplerDiagnostics;
use super::trends::TrendDiagnostics;
use super::verification::VerificationDiagnostics;
use crate::flag::Flag;

/// How far a calibration can be trusted, and where its model fails. What a fit or a search cannot determine is null or empty.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Diagnostics {
    /// The sampler; null of a fit.
    pub sampler: Option<SamplerDiagnostics>,
    /// Information and misfit of each channel, in the order of all tables.
    pub channels: Vec<ChannelDiagnostics>,
    /// The misfit of all fitted data together; null where the noise of all is inferred.
    pub chi_square: Option<ChiSquareTest>,
    /// Every fitted measurement beside its prediction.
    pub residuals: Vec<ResidualDiagnostics>,
    /// The residuals of each channel against each condition that its runs vary.
    pub trends: Vec<TrendDiagnostics>,
    /// Contraction, bounds and prior conflict of each parameter, in the order of the job.
    pub parameters: Vec<ParameterDiagnostics>,
    /// The prior of all parameters together against the data.
    pub conflict: Option<PriorConflict>,
    /// Combinations of parameters, the worst known first.
    pub directions: Vec<DirectionDiagnostics>,
    /// Refusals and faults by region of the prior.
    pub rejections: RejectionDiagnostics,
    /// How many results a second worker has computed as well.
    pub verification: VerificationDiagnostics,
    /// The findings in plain words.
    pub findings: Vec<String>,
    /// The flags.
    pub flags: Vec<Flag>,
}
