//! The promises of the farm, and the report of a broken one.

use std::fmt;

/// A condition that must hold at every moment of a schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Promise {
    /// A lease asks, to the bit, the question that the run without faults asks under its number.
    Question,
    /// Lease numbers grow, over restarts too.
    Fence,
    /// No evaluation is leased while another lease of it is out: neither answered, failed, returned by its worker, expired nor lost.
    OneHolder,
    /// A suspect is leased to a worker that holds nothing, and the holder of a suspect gets nothing else.
    Alone,
    /// No evaluation is leased that has its row.
    NotAgain,
    /// No evaluation of a paused or finished calibration is leased.
    Open,
    /// A calibration is pinned once to a version of the equations, by a result. From then on only workers of that version lease and answer.
    Version,
    /// A row has the bits of the run without faults.
    Row,
    /// An evaluation has one row.
    Once,
    /// A failed attempt is that of a worker that had reported the start or a fault; each is counted once.
    Attempt,
    /// Only a user, three failed attempts at an evaluation or twenty leases that nobody began pause a calibration; only failures on three
    /// workers, or a user who skips it, give an evaluation up.
    Pause,
    /// Acknowledged results are on disk, and are there after a restart.
    Acknowledged,
    /// Two different answers to one evaluation are a dispute.
    Dispute,
    /// A worker that computes wrongly gets no lease, and no other worker is accused.
    Quarantine,
    /// Stages, draws, evidence and estimate have the bits of the run without faults.
    Result,
    /// A finished calibration has all its rows and its result.
    Complete,
    /// A restart takes up every calibration that is not over.
    Replay,
    /// Once faults cease, every calibration ends.
    End,
}

/// A broken promise, with an explanation.
#[derive(Debug, Clone)]
pub(crate) struct Broken {
    pub(crate) promise: Promise,
    pub(crate) how: String,
}

impl Broken {
    pub(crate) fn new(promise: Promise, how: impl Into<String>) -> Self {
        Broken {
            promise,
            how: how.into(),
        }
    }
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:?}: {}", self.promise, self.how)
    }
}

/// Returns `Err` with the promise where the condition does not hold.
pub(crate) fn demand(holds: bool, promise: Promise, how: impl FnOnce() -> String) -> Result<(), Broken> {
    if holds {
        Ok(())
    } else {
        Err(Broken::new(promise, how()))
    }
}
