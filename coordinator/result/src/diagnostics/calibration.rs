//! `Diagnostics`, the answer of the REST interface about one calibration: all diagnostics with their findings and flags.

use super::channels::{ChannelDiagnostics, ChiSquareTest};
use super::directions::DirectionDiagnostics;
use super::emulator::EmulatorDiagnostics;
use super::parameters::{ParameterDiagnostics, PriorConflict};
use super::rejections::RejectionDiagnostics;
use super::residuals::ResidualDiagnostics;
use super::sampler::SamplerDiagnostics;
use super::trends::TrendDiagnostics;
use super::verification::VerificationDiagnostics;
use crate::flag::Flag;

/// The diagnostics of a calibration: how far it can be trusted, and where its model fails. Entries that a fit or a search cannot
/// determine are null or empty.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Diagnostics {
    /// The sampler; null for a fit.
    pub sampler: Option<SamplerDiagnostics>,
    /// The emulator that the sampler drew on; null without one.
    #[serde(default)]
    pub emulator: Option<EmulatorDiagnostics>,
    /// Information and misfit of each channel, in the same order as in all tables.
    pub channels: Vec<ChannelDiagnostics>,
    /// The misfit of all fitted data together; null if all noise is inferred.
    pub chi_square: Option<ChiSquareTest>,
    /// Residuals: every fitted measurement compared with its prediction.
    pub residuals: Vec<ResidualDiagnostics>,
    /// The residuals of each channel against each condition that its runs vary.
    pub trends: Vec<TrendDiagnostics>,
    /// Contraction, bounds and prior conflict of each parameter, in the order of the job.
    pub parameters: Vec<ParameterDiagnostics>,
    /// The conflict of the whole prior with the data.
    pub conflict: Option<PriorConflict>,
    /// Combinations of parameters, the worst-known first.
    pub directions: Vec<DirectionDiagnostics>,
    /// Rejections: where in the prior the model rejects parameters and leases fail.
    pub rejections: RejectionDiagnostics,
    /// How many results a second worker computed again.
    pub verification: VerificationDiagnostics,
    /// The findings, one sentence each.
    pub findings: Vec<String>,
    /// Flags of the calibration.
    pub flags: Vec<Flag>,
}
