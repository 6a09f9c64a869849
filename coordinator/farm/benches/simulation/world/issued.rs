//! A lease that was given: its holder and its honest answer.

use shared::exchange::{Lease, WorkResult};
use shared::model::equations_of;

use super::case::{Answered, Case};
use super::ledger::Table;

/// A lease that was given.
#[derive(Debug, Clone)]
pub(crate) struct Issued<'a> {
    pub(crate) worker: String,
    pub(crate) lease: Lease,
    pub(super) case: &'a Case,
    pub(crate) answered: &'a Answered,
    /// Whether the evaluation kills every worker.
    pub(crate) poison: bool,
    /// The version of the equations that its worker computes.
    pub(super) version: String,
    /// The number of backups that were restored before.
    pub(super) history: u32,
}

impl Issued<'_> {
    /// Returns whether the lease belongs to this calibration, and not to a lost one with the same number, and has its pinned version.
    pub(super) fn is_of(&self, table: &Table) -> bool {
        let pinned = table.model_version.as_deref().map(equations_of);
        std::ptr::eq(self.case, table.case) && pinned.is_none_or(|pinned| pinned == self.version)
    }

    /// Returns the honest answer.
    pub(crate) fn answer(&self) -> WorkResult {
        WorkResult {
            lease: self.lease.lease,
            calibration: self.lease.calibration,
            evaluation: self.lease.evaluation,
            seal: self.lease.seal.clone(),
            outcome: self.answered.outcome.clone(),
            repeated: None,
        }
    }
}

/// A lease that is out.
#[derive(Debug, Clone)]
pub(super) struct Live {
    pub(super) lease: u64,
    pub(super) worker: String,
    /// The worker's version of the equations.
    pub(super) version: String,
    pub(super) since_ms: u64,
    pub(super) until_ms: u64,
    pub(super) started: bool,
    pub(super) is_suspect: bool,
}
