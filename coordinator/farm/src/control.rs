//! The commands of a user on a calibration.

use shared::api::CalibrationState;

/// The reason why a user's command on a calibration is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ControlError {
    /// The calibration is over, or does not exist.
    #[error("calibration {0} is not in progress")]
    NotInProgress(i64),
    /// The calibration has no result yet, or never will.
    #[error("calibration {id} is {}; results are available when it is finished", state.name())]
    NotFinished {
        /// Id of the calibration.
        id: i64,
        /// State of the calibration.
        state: CalibrationState,
    },
    /// The command does not fit the state.
    #[error("calibration {id} is {}; it cannot be {verb}", state.name())]
    WrongState {
        /// Id of the calibration.
        id: i64,
        /// State of the calibration.
        state: CalibrationState,
        /// Verb of the refused command.
        verb: &'static str,
    },
    /// No connected worker computes the version that a calibration shall go on with.
    #[error(
        "no connected worker computes version {version:?}; the connected ones compute {}",
        listed(connected)
    )]
    NoSuchVersion {
        /// The version that was asked for.
        version: String,
        /// The versions of the connected workers, without those that are quarantined.
        connected: Vec<String>,
    },
}

fn listed(versions: &[String]) -> String {
    match versions.is_empty() {
        true => "none".into(),
        false => versions.join(", "),
    }
}

/// A user's command on a calibration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Control {
    /// Stops the calibration for good.
    Cancel,
    /// Leases nothing until the calibration is resumed.
    Pause,
    /// Resumes a paused calibration.
    Resume {
        /// Whether evaluations without attempts left count as rejected; otherwise they get new attempts.
        skip_faults: bool,
    },
    /// Goes on with workers of a version of the equations alone, whatever version the first result has pinned. Results of another version
    /// are dropped.
    ComputeWith(String),
}
