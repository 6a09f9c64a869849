//! Stored state that a restart of an unfinished calibration needs.

use std::collections::BTreeMap;

use shared::api::CalibrationState;
use statistics::SubchainEnd;

use crate::fact::Fingerprint;

/// Stored state of an unfinished calibration.
#[derive(Debug, Default)]
pub struct Stored {
    /// State before the restart.
    pub state: Option<CalibrationState>,
    /// Reason for which it was paused.
    pub message: Option<String>,
    /// The pinned version of the model.
    pub model_version: Option<String>,
    /// Wall time spent before the restart `[ms]`.
    pub busy_ms: u64,
    /// Stored evaluations by number.
    pub evaluations: BTreeMap<u64, StoredEvaluation>,
    /// Whether some of its results were dropped.
    pub is_rewound: bool,
    /// The workers of failed leases, by evaluation.
    pub failed: BTreeMap<u64, Vec<String>>,
}

/// The parts of an evaluation that a replay needs.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredEvaluation {
    /// Parameter vector.
    pub theta: Vec<f64>,
    /// Log-likelihood; `None` where the model rejected or nothing was scored.
    pub log_likelihood: Option<f64>,
    /// Whether the model rejected.
    pub rejected: bool,
    /// Name of the worker that computed it; empty if it was given up after faults.
    pub worker: String,
    /// Fingerprint that a second computation must reproduce.
    pub fingerprint: Fingerprint,
    /// Whether another worker has reproduced it.
    pub is_confirmed: bool,
    /// The model's values of the fitted measurements; read back for a fit and with a metamodel.
    pub fitted: Option<Vec<f64>>,
    /// The quasi-static model's values of the fitted measurements; read back with a metamodel only.
    pub coarse: Option<Vec<f64>>,
    /// End of the requested subchain.
    pub end: Option<SubchainEnd>,
}
