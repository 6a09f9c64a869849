//! What the farm promises, and what is said of a promise that is broken.

use std::fmt;

/// What must hold at every moment of a schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Promise {
    /// A lease asks, to the bit, what the run without faults asks under its number.
    Question,
    /// Lease numbers grow, over restarts too.
    Fence,
    /// No evaluation is leased while another lease of it is out: neither answered, failed, returned by its worker, expired nor lost.
    OneHolder,
    /// A suspect is leased to a worker that holds nothing, and whoever holds one gets nothing else.
    Alone,
    /// No evaluation is leased that has its row.
    NotAgain,
    /// Nothing of a calibration is leased that is paused or over.
    Open,
    /// A calibration is pinned once to a version of the equations, by a result; from then on workers of that version alone lease and
    /// answer.
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
    /// What was acknowledged is on disk, and is there after a restart.
    Acknowledged,
    /// Two different answers to one evaluation are a dispute.
    Dispute,
    /// Whoever computes wrongly gets no lease, and nobody else is said to.
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

/// A promise that was broken, and how.
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

/// `Err` with the promise where it does not hold.
pub(crate) fn demand(holds: bool, promise: Promise, how: impl FnOnce() -> String) -> Result<(), Broken> {
    if holds {
        Ok(())
    } else {
        Err(Broken::new(promise, how()))
    }
}
