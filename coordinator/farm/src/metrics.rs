//! Numbers of the farm for the metrics page.

/// Counters for the metrics page.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FarmCounters {
    /// Number of results that were accepted.
    pub completed: u64,
    /// Number of accepted results from workers of a queue's job.
    pub completed_in_queues: u64,
    /// Results that changed nothing.
    pub duplicates: u64,
    /// Results whose seal does not match.
    pub refused: u64,
    /// Number of leases given out.
    pub leased: u64,
    /// Leases that never reached their worker.
    pub lost: u64,
    /// Results that a second worker has confirmed.
    pub confirmed: u64,
    /// Results that no worker was there to confirm.
    pub unanswered: u64,
    /// Leases that expired or ended in a fault.
    pub failed_leases: u64,
}

/// Numbers for the metrics page.
#[derive(Debug, Clone)]
pub struct FarmMetrics {
    /// Counters since the start.
    pub counters: FarmCounters,
    /// Evaluations that wait for a worker.
    pub queued: u64,
    /// Leases that are out.
    pub leased: usize,
    /// Number of calibrations in progress.
    pub calibrations: usize,
    /// Number of connected workers.
    pub workers: usize,
    /// Results that wait for a second answer.
    pub unconfirmed: usize,
    /// Workers that compute wrongly.
    pub quarantined: usize,
    /// Calibrations whose engine takes a step, or waits for a thread to take it.
    pub stepping: usize,
}
