//! Claims and their outcomes: completions, failures, expiry.

/// The number of failed leases after which an evaluation is given up.
pub const MAX_ATTEMPTS: u32 = 3;

/// The number of leases in a row that nobody began, after which a calibration pauses.
pub const MAX_UNSTARTED: u32 = 20;

/// The effect of a completion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Completion {
    /// The first valid completion, which counts.
    First,
    /// A further completion, which is only acknowledged and compared.
    Duplicate,
    /// A completion of an evaluation that is not in the present round.
    Unknown,
}

/// A lease that failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeaseFailure {
    /// Number of the evaluation.
    pub evaluation: u64,
    /// The worker that held the lease.
    pub worker: String,
    /// The number of failed leases of this evaluation so far.
    pub attempt: u32,
    /// The number of different workers on which leases of this evaluation failed.
    pub workers: usize,
}

/// A worker that claims evaluations.
#[derive(Debug, Clone, Copy)]
pub struct Claimant<'a> {
    /// Name of the worker.
    pub worker: &'a str,
    /// The identity that the worker counts as in comparisons of answers.
    pub voter: &'a str,
    /// The number of leases that the worker holds, of any calibration.
    pub holds: usize,
    /// The present time `[ms]`.
    pub now_ms: u64,
    /// The time at which the leases expire `[ms]`.
    pub expires_ms: u64,
}

/// A claim on an evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NewClaim {
    /// Number of the lease.
    pub lease: u64,
    /// Number of the evaluation.
    pub evaluation: u64,
    /// Whether the evaluation is a suspect, whose start must be reported.
    pub suspect: bool,
}

/// The leases that have expired.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Expired {
    /// The started leases, which are failed attempts.
    pub failures: Vec<LeaseFailure>,
    /// The number of expired leases that nobody had started.
    pub unstarted: u64,
    /// Evaluations that were leased [`MAX_UNSTARTED`] times in a row without being begun.
    pub never_begun: Vec<u64>,
}

impl LeaseFailure {
    /// Returns whether no attempt is left.
    pub fn exhausted(&self) -> bool {
        self.attempt >= MAX_ATTEMPTS
    }

    /// Returns whether so many different workers failed that the evaluation is at fault, and not a machine.
    pub fn is_evaluations_own(&self) -> bool {
        self.workers >= MAX_ATTEMPTS as usize
    }
}

/// A lease that has been out for a long time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SlowLease {
    /// Number of the lease.
    pub lease: u64,
    /// The worker that holds the lease.
    pub worker: String,
}
