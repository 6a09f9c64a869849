//! Facts that the store receives, in order of occurrence.

use inference::point_estimate::ModeEstimate;
use inference::{PosteriorSample, StageRecord};
use shared::api::CalibrationState;
use shared::exchange::RepeatedAnswer;
use shared::outcome::Observables;
use statistics::SubchainEnd;

use crate::discovery::Discovery;

/// Something that must survive a restart.
#[derive(Debug, Clone)]
pub enum Fact {
    /// A parameter vector was simulated.
    Evaluated {
        /// The calibration.
        calibration: i64,
        /// The evaluation.
        row: EvaluationRow,
    },
    /// A late result of an evaluation that is already stored; compared, because it must be equal.
    Duplicate {
        /// The calibration.
        calibration: i64,
        /// The evaluation.
        evaluation: u64,
        /// Fingerprint that must agree.
        fingerprint: Fingerprint,
        /// Who computed it.
        worker: String,
    },
    /// A stage ended.
    Stage {
        /// The calibration.
        calibration: i64,
        /// The stage with its population.
        record: Box<StageRecord>,
        /// Wall time spent on the calibration so far `[ms]`.
        busy_ms: u64,
    },
    /// The sampler ended.
    Posterior {
        /// The calibration.
        calibration: i64,
        /// Evidence and counts; the draws are the last stage's population.
        posterior: Box<PosteriorSample>,
    },
    /// The fit ended.
    Estimate {
        /// The calibration.
        calibration: i64,
        /// The most probable parameters.
        estimate: Box<ModeEstimate>,
    },
    /// A search for a missing effect ended.
    Discovery {
        /// The calibration.
        calibration: i64,
        /// Its result.
        record: Box<Discovery>,
    },
    /// A calibration changed its state.
    State {
        /// The calibration.
        calibration: i64,
        /// The new state.
        state: CalibrationState,
        /// The reason, where there is one.
        message: Option<String>,
        /// Wall time spent on the calibration so far `[ms]`.
        busy_ms: u64,
    },
    /// A second worker has reproduced a stored result.
    Confirmed {
        /// The calibration.
        calibration: i64,
        /// The evaluation.
        evaluation: u64,
        /// The second worker.
        worker: String,
    },
    /// A worker computes wrongly: it gets no leases, and nothing that it says counts.
    Quarantined {
        /// The worker.
        worker: String,
        /// The calibration that shows it.
        calibration: i64,
        /// The evaluation that shows it.
        evaluation: u64,
    },
    /// The unconfirmed results of a worker that computes wrongly are dropped, and what followed from them.
    Rewound {
        /// The calibration.
        calibration: i64,
        /// The worker.
        worker: String,
        /// Evaluations of a round.
        width: usize,
    },
    /// A model that is not ours was asked the same twice.
    Repeated {
        /// The calibration.
        calibration: i64,
        /// How far its answers differ.
        repeated: RepeatedAnswer,
    },
    /// The first result pinned the version of the equations, and of the effects.
    ModelVersion {
        /// The calibration.
        calibration: i64,
        /// The version.
        version: String,
    },
    /// A machine failed at an evaluation.
    Fault {
        /// The calibration.
        calibration: i64,
        /// The evaluation.
        evaluation: u64,
        /// Number of failed leases of it so far.
        attempt: u32,
        /// The machine's worker.
        worker: String,
        /// The error message.
        message: String,
    },
}

/// Two different answers to one evaluation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dispute {
    /// The evaluation.
    pub evaluation: u64,
    /// The worker whose answer is stored.
    pub first: String,
    /// The worker whose answer differs; it may be the same.
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
    /// The quasi-static model's values of the fitted measurements, where it was evaluated.
    pub coarse: Option<Vec<f64>>,
    /// End of the requested subchain; `theta` is that end.
    pub end: Option<SubchainEnd>,
    /// Fingerprint that a second computation must reproduce.
    pub fingerprint: Fingerprint,
    /// Who computed it.
    pub worker: String,
}

/// The kept part of a result.
#[derive(Debug, Clone, PartialEq)]
pub enum Kept {
    /// While sampling: nothing beside the log-likelihood. Also where a subchain stayed.
    Scored,
    /// The predicted values that the likelihood takes: of draws from the prior, and of what an engine is told again.
    Fitted(Vec<f64>),
    /// Of the final draws: everything.
    Whole(Box<Observables>),
    /// The model rejected, with its reason.
    Rejected(String),
}

impl Kept {
    /// Whether the model rejected.
    pub fn is_rejected(&self) -> bool {
        matches!(self, Kept::Rejected(_))
    }

    /// The kept predicted values.
    pub fn fitted(&self) -> Option<&[f64]> {
        match self {
            Kept::Fitted(values) => Some(values),
            Kept::Scored | Kept::Whole(_) | Kept::Rejected(_) => None,
        }
    }
}

/// Two computations of an evaluation must have the same one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint(pub i64);
