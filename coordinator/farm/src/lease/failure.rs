//! What claims are made of and what comes of them: completions, failures, expiry.

/// An evaluation is given up after so many failed leases.
pub const MAX_ATTEMPTS: u32 = 3;

/// A calibration pauses after an evaluation was leased so often in a row without being begun.
pub const MAX_UNSTARTED: u32 = 20;

/// How a completion was received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Completion {
    /// The first valid one: it counts.
    First,
    /// Already completed: acknowledged, compared, ignored.
    Duplicate,
    /// Not asked for at present: of an earlier round, or never.
    Unknown,
}

/// A lease that failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeaseFailure {
    /// The evaluation.
    pub evaluation: u64,
    /// Who held it.
    pub worker: String,
    /// How many leases of this evaluation have failed by now.
    pub attempt: u32,
    /// On how many different workers.
    pub workers: usize,
}

/// Who claims, and until when.
#[derive(Debug, Clone, Copy)]
pub struct Claimant<'a> {
    /// The worker.
    pub worker: &'a str,
    /// How many leases it holds, of any calibration.
    pub holds: usize,
    /// Now `[ms]`.
    pub now_ms: u64,
    /// When the leases expire `[ms]`.
    pub expires_ms: u64,
}

/// A claim on an evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NewClaim {
    /// The lease.
    pub lease: u64,
    /// The evaluation.
    pub evaluation: u64,
    /// Whether it is a suspect, whose start must be reported.
    pub suspect: bool,
}

/// What the passing of time has ended.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Expired {
    /// Started leases: failed attempts.
    pub failures: Vec<LeaseFailure>,
    /// How many leases expired that nobody had started.
    pub unstarted: u64,
    /// Evaluations that were leased [`MAX_UNSTARTED`] times in a row without being begun.
    pub never_begun: Vec<u64>,
}

impl LeaseFailure {
    /// Whether the evaluation is tried no more.
    pub fn exhausted(&self) -> bool {
        self.attempt >= MAX_ATTEMPTS
    }

    /// Whether so many different workers failed that the evaluation, not a machine, is at fault.
    pub fn is_evaluations_own(&self) -> bool {
        self.workers >= MAX_ATTEMPTS as usize
    }
}

/// A lease that has been out for long.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SlowLease {
    /// Its number.
    pub lease: u64,
    /// Who holds it.
    pub worker: String,
}
