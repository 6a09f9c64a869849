//! Facts that the store receives, in order of occurrence.

use inference::EmulatorRecord;
use inference::point_estimate::ModeEstimate;
use inference::{PosteriorSample, StageRecord};
use shared::api::CalibrationState;
use shared::exchange::RepeatedAnswer;
use shared::outcome::Observables;

use crate::discovery::Discovery;

/// A fact that must survive a restart.
#[derive(Debug, Clone)]
pub enum Fact {
    /// A parameter vector was simulated.
    Evaluated {
        /// Id of the calibration.
        calibration: i64,
        /// Row of the evaluation in the store.
        row: EvaluationRow,
    },
    /// A late result of a stored evaluation; it is compared with the stored one, which it must equal.
    Duplicate {
        /// Id of the calibration.
        calibration: i64,
        /// Number of the evaluation.
        evaluation: u64,
        /// Fingerprint that must agree with the stored one.
        fingerprint: Fingerprint,
        /// Name of the worker that computed the evaluation.
        worker: String,
    },
    /// A stage ended.
    Stage {
        /// Id of the calibration.
        calibration: i64,
        /// The stage with its population.
        record: Box<StageRecord>,
        /// Wall time spent on the calibration so far `[ms]`.
        busy_ms: u64,
    },
    /// The sampler ended.
    Posterior {
        /// Id of the calibration.
        calibration: i64,
        /// Evidence and counts; the draws are the last stage's population.
        posterior: Box<PosteriorSample>,
        /// What the sampler found about its emulator; `None` for a sampler without one.
        emulator: Option<Box<EmulatorRecord>>,
    },
    /// The fit ended.
    Estimate {
        /// Id of the calibration.
        calibration: i64,
        /// The most probable parameters.
        estimate: Box<ModeEstimate>,
    },
    /// A search for a missing effect ended.
    Discovery {
        /// Id of the calibration.
        calibration: i64,
        /// The result as a record.
        record: Box<Discovery>,
    },
    /// A calibration changed its state.
    State {
        /// Id of the calibration.
        calibration: i64,
        /// New state of the calibration.
        state: CalibrationState,
        /// The reason, if there is one.
        message: Option<String>,
        /// Wall time spent on the calibration so far `[ms]`.
        busy_ms: u64,
    },
    /// A calibration that is over needs no predicted values of its evaluations any more. This fact follows that of the state.
    ValuesExpired {
        /// Id of the calibration.
        calibration: i64,
        /// The first of these evaluations.
        from: u64,
    },
    /// A second worker has reproduced a stored result.
    Confirmed {
        /// Id of the calibration.
        calibration: i64,
        /// Number of the evaluation.
        evaluation: u64,
        /// Name of the second worker.
        worker: String,
    },
    /// A worker computes wrongly: it gets no further leases, and its answers are ignored.
    Quarantined {
        /// Name of the worker.
        worker: String,
        /// Id of the calibration that shows it.
        calibration: i64,
        /// Number of the evaluation that shows it.
        evaluation: u64,
    },
    /// The unconfirmed results of a worker that computes wrongly are dropped, with all later results that depend on them.
    Rewound {
        /// Id of the calibration.
        calibration: i64,
        /// Name of the worker.
        worker: String,
        /// Number of evaluations in a round.
        width: usize,
    },
    /// An external model was evaluated twice at the same parameters.
    Repeated {
        /// Id of the calibration.
        calibration: i64,
        /// Difference of its answers.
        repeated: RepeatedAnswer,
    },
    /// The first result pinned the version of the equations, and of the effects.
    ModelVersion {
        /// Id of the calibration.
        calibration: i64,
        /// Pinned version of the model.
        version: String,
    },
    /// The operator has pinned another version of the equations; all results of the calibration are dropped.
    Repinned {
        /// Id of the calibration.
        calibration: i64,
        /// Pinned version of the model.
        version: String,
    },
    /// A machine failed at an evaluation.
    Fault {
        /// Id of the calibration.
        calibration: i64,
        /// Number of the evaluation.
        evaluation: u64,
        /// Number of its leases that have failed so far.
        attempt: u32,
        /// Name of the machine's worker.
        worker: String,
        /// Message of the failure.
        message: String,
    },
}

/// Two different answers to one evaluation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dispute {
    /// Number of the evaluation.
    pub evaluation: u64,
    /// Name of the worker whose answer is stored.
    pub first: String,
    /// Name of the worker whose answer differs; it may be the first worker.
    pub second: String,
}

/// A simulated parameter vector, as the store keeps it.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluationRow {
    /// Number of the evaluation within its calibration.
    pub evaluation: u64,
    /// The whole parameter vector, noise parameters included.
    pub theta: Vec<f64>,
    /// Log-likelihood; `None` where the model rejected or nothing was scored.
    pub log_likelihood: Option<f64>,
    /// The kept part of the result.
    pub kept: Kept,
    /// Fingerprint that a second computation must reproduce.
    pub fingerprint: Fingerprint,
    /// Name of the worker that computed the evaluation.
    pub worker: String,
}

/// The kept part of a result.
#[derive(Debug, Clone, PartialEq)]
pub enum Kept {
    /// Nothing beside the log-likelihood, while sampling.
    Scored,
    /// The predicted values that the likelihood takes, for draws from the prior and for evaluations that are told to an engine again.
    Fitted(Vec<f64>),
    /// All observables, for a final draw.
    Whole(Box<Observables>),
    /// The reason for which the model rejected the parameters.
    Rejected(String),
}

impl Kept {
    /// Returns whether the model rejected.
    pub fn is_rejected(&self) -> bool {
        matches!(self, Kept::Rejected(_))
    }

    /// Returns the kept predicted values.
    pub fn fitted(&self) -> Option<&[f64]> {
        match self {
            Kept::Fitted(values) => Some(values),
            Kept::Scored | Kept::Whole(_) | Kept::Rejected(_) => None,
        }
    }
}

/// The fingerprint of a result, which a second computation must reproduce.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint(pub i64);
