//! Stored state that a restart of an unfinished calibration needs.

use std::collections::BTreeMap;

use shared::api::CalibrationState;
use statistics::SubchainEnd;

use crate::fact::Fingerprint;

/// Stored state of an unfinished calibration.
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
    /// Its evaluations by number: parameter vector, log-likelihood, whether the model rejected.
    pub evaluations: BTreeMap<u64, StoredEvaluation>,
    /// Whether results of it were dropped.
    pub is_rewound: bool,
    /// The workers of failed leases, by evaluation.
    pub failed: BTreeMap<u64, Vec<String>>,
}

/// An evaluation as far as a replay needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredEvaluation {
    /// Parameter vector.
    pub theta: Vec<f64>,
    /// Log-likelihood; `None` where the model rejected or nothing was scored.
    pub log_likelihood: Option<f64>,
    /// Whether the model rejected.
    pub rejected: bool,
    /// Who computed it; empty where it was given up after faults.
    pub worker: String,
    /// Fingerprint that a second computation must reproduce.
    pub fingerprint: Fingerprint,
    /// Whether another worker has reproduced it.
    pub is_confirmed: bool,
    /// The model's values of the fitted measurements; read back for a fit and with a metamodel, which need
    /// them.
    pub fitted: Option<Vec<f64>>,
    /// Those of the quasi-static model; read back with a metamodel alone.
    pub coarse: Option<Vec<f64>>,
    /// End of the subchain.
    pub end: Option<SubchainEnd>,
}
