//! What a restart needs of a calibration that is not over.

use std::collections::BTreeMap;

use shared::api::CalibrationState;
use statistics::SubchainEnd;

/// What the store kept of a calibration that is not over.
#[derive(Debug, Default)]
pub struct Stored {
    /// The state that it was left in.
    pub state: Option<CalibrationState>,
    /// Why it was paused.
    pub message: Option<String>,
    /// The pinned version of the model.
    pub model_version: Option<String>,
    /// Wall time spent before `[ms]`.
    pub busy_ms: u64,
    /// Its evaluations by number: parameter vector, log-likelihood, whether the model refused.
    pub evaluations: BTreeMap<u64, StoredEvaluation>,
    /// Failed leases by evaluation.
    pub failed: BTreeMap<u64, u32>,
}

/// An evaluation as far as a replay needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredEvaluation {
    /// Parameter vector.
    pub theta: Vec<f64>,
    /// Log-likelihood; `None` where the model refused or nothing was scored.
    pub log_likelihood: Option<f64>,
    /// Whether the model refused.
    pub rejected: bool,
    /// The model's values of the fitted measurements; read back for a fit and with a metamodel, which are told
    /// them.
    pub fitted: Option<Vec<f64>>,
    /// Those of the quasi-static model; read back with a metamodel alone.
    pub coarse: Option<Vec<f64>>,
    /// Where the subchain ended.
    pub end: Option<SubchainEnd>,
}
