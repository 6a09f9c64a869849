//! Counters of the writer, for the metrics page.

use std::sync::atomic::AtomicU64;

/// Figures of the writer, for the metrics page.
#[derive(Debug, Default)]
pub struct StoreHealth {
    /// Facts sent to the writer.
    pub sent: AtomicU64,
    /// Commits.
    pub commits: AtomicU64,
    /// Facts committed.
    pub facts: AtomicU64,
    /// Time spent writing and committing `[us]`.
    pub busy_us: AtomicU64,
    /// Late duplicates that differed from what is stored: faults of determinism.
    pub differing_duplicates: AtomicU64,
}
