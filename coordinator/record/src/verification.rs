//! How far the answers of workers are verified.

use std::collections::BTreeMap;

use shared::exchange::RepeatedAnswer;

/// A worker that computes wrongly.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quarantine {
    /// The worker.
    pub worker: String,
    /// The calibration that shows it.
    pub calibration: i64,
    /// The evaluation that shows it.
    pub evaluation: u64,
}

/// How far the results of a calibration are verified.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Verified {
    /// Results that are stored.
    pub results: u64,
    /// Of these, reproduced by a second worker.
    pub confirmed: u64,
    /// Workers that computed them.
    pub workers: u64,
    /// Results of workers that were quarantined after the calibration ended, which nobody has confirmed.
    pub resting_on: BTreeMap<String, u64>,
    /// Results of workers that were quarantined, which were computed again.
    pub computed_again: BTreeMap<String, u64>,
}

/// How a model that is not ours answered what it was asked twice.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Repeats {
    /// Evaluations that were asked for twice.
    pub evaluations: u64,
    /// Of these, answered in two ways.
    pub differing: u64,
    /// The largest differences.
    pub largest: RepeatedAnswer,
}
