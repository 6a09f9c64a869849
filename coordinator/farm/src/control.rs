//! The commands of a user on a calibration.

use shared::api::CalibrationState;

/// Why a user's command on a calibration is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ControlError {
    /// It is over, or was never there.
    #[error("calibration {0} is not in progress")]
    NotInProgress(i64),
    /// There is no result yet, or there never will be one.
    #[error("calibration {id} is {}; results are available when it is finished", state.name())]
    NotFinished {
        /// The calibration.
        id: i64,
        /// Its state.
        state: CalibrationState,
    },
    /// The command does not fit the state.
    #[error("calibration {id} is {}; it cannot be {verb}", state.name())]
    WrongState {
        /// The calibration.
        id: i64,
        /// Its state.
        state: CalibrationState,
        /// The command.
        verb: &'static str,
    },
}

/// A user's command on a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Stop; it cannot be resumed.
    Cancel,
    /// Lease nothing until resumed.
    Pause,
    /// Resume.
    Resume {
        /// Whether evaluations that had used up their attempts count as rejected; else they get new attempts.
        skip_faults: bool,
    },
}
