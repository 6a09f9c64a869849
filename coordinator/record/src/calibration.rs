//! A calibration and its experiment, as they are stored.

use shared::api::CalibrationState;
use shared::file::FileSet;

/// A stored experiment.
#[derive(Debug, Clone)]
pub struct ExperimentRow {
    /// Its id.
    pub id: i64,
    /// Its files.
    pub files: FileSet,
}

/// Seals the leases of one calibration: random, drawn when the calibration is stored, never shown.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct SealKey(pub [u8; 16]);

impl std::fmt::Debug for SealKey {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("SealKey(..)")
    }
}

/// A stored calibration.
#[derive(Debug, Clone)]
pub struct CalibrationRow {
    /// Its id.
    pub id: i64,
    /// The study it belongs to.
    pub study: i64,
    /// The experiment it is about.
    pub experiment: i64,
    /// Name for lists.
    pub name: String,
    /// Its job, with the effect files that it names.
    pub job: FileSet,
    /// Its state.
    pub state: CalibrationState,
    /// Why it is paused or failed.
    pub message: Option<String>,
    /// Version of the equations.
    pub model_version: Option<String>,
    /// Wall time spent `[ms]`.
    pub busy_ms: u64,
    /// Log-evidence.
    pub log_evidence: Option<f64>,
    /// Its standard error.
    pub log_evidence_se: Option<f64>,
    /// Whether every stage reached equilibrium.
    pub equilibrated: Option<bool>,
    /// Evaluations of the sampler.
    pub evaluations: Option<u64>,
    /// Of these, rejected by the model.
    pub rejected: Option<u64>,
}
