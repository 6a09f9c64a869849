//! Stored state that a restart of an unfinished calibration needs.

use std::collections::BTreeMap;

use shared::api::CalibrationState;

use crate::fact::EvaluationRow;

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
    /// Stored evaluations by number. Observables are not loaded; values of fitted measurements only where an engine needs them.
    pub evaluations: BTreeMap<u64, EvaluationRow>,
    /// The evaluations whose answer another worker has reproduced, with that worker.
    pub confirmed: BTreeMap<u64, String>,
    /// Whether some of its results were dropped.
    pub is_rewound: bool,
    /// Whether a worker that computed or confirmed results of it, or answered it wrongly, computes wrongly.
    pub is_doubted: bool,
    /// The workers of failed leases, by evaluation.
    pub failed: BTreeMap<u64, Vec<String>>,
}
