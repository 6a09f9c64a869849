//! Errors of the service, each with its message.

use shared::api::CalibrationState;
use shared::file::FileError;
use tokio::task::JoinError;

use crate::webhook::WebhookError;
use farm::ControlError;
use farm::calibration::BeginError;
use farm::calibration::replay::ReplayError;
use farm::dispatch::Stopped;
use job::EffectsChanged;
use prediction::PredictionError;
use record::CalibrationRow;
use store::StoreError;

#[derive(Debug, thiserror::Error)]
pub enum ServiceError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Begin(#[from] BeginError),
    /// The facts that this version computes differ from the stored ones.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A calibration could not be resumed at the start.
    #[error("calibration {id} cannot be resumed: {reason}")]
    LeftAlone { id: i64, reason: String },
    /// The name of an effect to add is that of an effect of the library.
    #[error("the effect {0} belongs to the library: give yours another name")]
    OfLibrary(String),
    #[error("effect {name} has no version {version:?}; the last one is {last}")]
    NoVersion {
        name: String,
        version: String,
        last: i64,
    },
    /// No messages can be posted to a URL.
    #[error(transparent)]
    Webhook(#[from] WebhookError),
    /// A study is not finished.
    #[error("calibration {calibration} of study {study} is {}; the study cannot be {verb}: wait, or cancel it first", state.name())]
    InProgress {
        study: i64,
        /// Id of the first unfinished calibration of the study.
        calibration: i64,
        state: CalibrationState,
        verb: &'static str,
    },
    #[error("study {0} is archived: restore it first")]
    Archived(i64),
    /// A study cannot be without what it began with.
    #[error(
        "calibration {0} was submitted: what was added to a study can be taken back, and a study can be archived or deleted"
    )]
    Submitted(i64),
    /// What people say of a study is too long, or blank.
    #[error("{0}")]
    Details(String),
    /// The effects differ from those with which the calibration was computed.
    #[error(transparent)]
    Effects(#[from] EffectsChanged),
    /// There is no prediction or decision.
    #[error(transparent)]
    Prediction(#[from] PredictionError),
    /// A search can be neither extended nor searched.
    #[error("calibration {0} is a search for a missing effect: name the calibration whose model it searches")]
    Search(i64),
    #[error("there is no {what} {id}")]
    NotFound { what: &'static str, id: String },
    /// The state of the calibration does not allow the command.
    #[error(transparent)]
    Control(#[from] ControlError),
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The operating system refuses a thread.
    #[error("failed to start the thread of the farm: {0}")]
    Thread(std::io::Error),
    /// A computation ended by a defect of the program.
    #[error("a computation of the service panicked: {0}")]
    Panicked(JoinError),
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// Too many facts wait for the store.
    #[error("{0} facts are waiting to be stored; try again in a second")]
    Busy(u64),
}

impl ServiceError {
    /// Makes the error that no `what` has this id.
    pub(super) fn not_found(what: &'static str, id: i64) -> Self {
        let id = id.to_string();
        ServiceError::NotFound { what, id }
    }

    /// Makes the error that a calibration has no result yet.
    pub(super) fn not_finished(row: &CalibrationRow) -> Self {
        let (id, state) = (row.id, row.state);
        ControlError::NotFinished { id, state }.into()
    }

    /// Makes the error of a computation that did not end: only one that was cancelled is worth another try.
    pub(super) fn not_ended(error: JoinError) -> Self {
        match error.is_panic() {
            true => ServiceError::Panicked(error),
            false => Stopped.into(),
        }
    }
}
