//! The cause of the replay of a calibration in progress.

/// Why a calibration in progress is replayed from the store.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ReplayCause {
    /// Results of a worker that computes wrongly were dropped.
    Worker,
    /// A user has chosen another version of the equations, so that results were dropped.
    Version,
    /// A step ended in an error of the program.
    Step,
}

impl ReplayCause {
    /// Returns the message of a replay that has failed for a reason.
    pub(super) fn failure(self, reason: &str) -> String {
        let what = match self {
            ReplayCause::Worker => {
                "results of a worker that computes wrongly were dropped, but the rest cannot be replayed"
            }
            ReplayCause::Version => {
                "results of another version of the equations were dropped, but the calibration cannot be replayed"
            }
            ReplayCause::Step => "the calibration whose next round could not be proposed cannot be replayed",
        };
        format!("{what}: {reason}")
    }
}
