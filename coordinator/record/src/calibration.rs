//! A calibration and its experiment, as they are stored.

use shared::api::CalibrationState;
use shared::file::FileSet;

use crate::membership::Membership;

/// A stored experiment.
#[derive(Debug, Clone)]
pub struct ExperimentRow {
    /// Id in the store.
    pub id: i64,
    /// Files of the experiment, by name.
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
    /// Id in the store.
    pub id: i64,
    /// Id of the study to which it belongs.
    pub study: i64,
    /// Id of its experiment.
    pub experiment: i64,
    /// Role in the study, and its parent.
    pub membership: Membership,
    /// Name for lists.
    pub name: String,
    /// Time of the submission, since the beginning of 1970 `[ms]`.
    pub created_ms: i64,
    /// The job, with the effect files that it names.
    pub job: FileSet,
    /// Progress: queued, running, finished and so on.
    pub state: CalibrationState,
    /// Reason for which the calibration is paused or has failed.
    pub message: Option<String>,
    /// Version of the equations.
    pub model_version: Option<String>,
    /// Wall time spent `[ms]`.
    pub busy_ms: u64,
    /// Log-evidence.
    pub log_evidence: Option<f64>,
    /// Standard error of the log-evidence.
    pub log_evidence_se: Option<f64>,
    /// Whether every stage reached equilibrium.
    pub equilibrated: Option<bool>,
    /// Number of evaluations by the sampler.
    pub evaluations: Option<u64>,
    /// Number of these that the model rejected.
    pub rejected: Option<u64>,
}

impl CalibrationRow {
    /// Returns a finished calibration with an empty job: a fixture of tests.
    #[doc(hidden)]
    pub fn finished(id: i64, membership: Membership) -> Self {
        CalibrationRow {
            id,
            study: 1,
            experiment: 1,
            membership,
            name: "sand".to_owned(),
            created_ms: 0,
            job: FileSet {
                toml: String::new(),
                files: Default::default(),
            },
            state: CalibrationState::Finished,
            message: None,
            model_version: None,
            busy_ms: 0,
            log_evidence: None,
            log_evidence_se: None,
            equilibrated: None,
            evaluations: None,
            rejected: None,
        }
    }
}
