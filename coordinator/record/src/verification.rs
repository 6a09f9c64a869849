//! Verification of the answers of workers.

use std::collections::BTreeMap;

use shared::exchange::RepeatedAnswer;

/// A worker that computes wrongly.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quarantine {
    /// Name of the worker.
    pub worker: String,
    /// Id of the calibration that shows it.
    pub calibration: i64,
    /// Number of the evaluation that shows it.
    pub evaluation: u64,
}

/// Counts of verified results of a calibration.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Verified {
    /// Number of stored results.
    pub results: u64,
    /// Number of these that a second worker has reproduced.
    pub confirmed: u64,
    /// Number of workers that computed these results.
    pub workers: u64,
    /// Number of results of workers that were quarantined after the calibration ended, and that nobody has confirmed.
    pub resting_on: BTreeMap<String, u64>,
    /// Number of results of quarantined workers that were computed again.
    pub computed_again: BTreeMap<String, u64>,
}

/// The answers of an external model to evaluations that were asked twice.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Repeats {
    /// Number of evaluations that were asked twice.
    pub evaluations: u64,
    /// Number of these with two different answers.
    pub differing: u64,
    /// Largest difference of each value.
    pub largest: RepeatedAnswer,
}
