//! Counters of the writer, for the metrics page.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// The time to wait for another program's lock before a warning.
pub(super) const PATIENCE: Duration = Duration::from_secs(5);

/// Counters of the writer, for the metrics page.
#[derive(Debug, Default)]
pub struct StoreHealth {
    /// Facts sent to the writer.
    pub sent: AtomicU64,
    /// Number of commits.
    pub commits: AtomicU64,
    /// Number of committed facts.
    pub facts: AtomicU64,
    /// Time spent writing and committing `[us]`.
    pub busy_us: AtomicU64,
    /// Late duplicates that differed from the stored results: faults of determinism.
    pub differing_duplicates: AtomicU64,
    /// Whether a lock of another program keeps the writer from writing.
    pub is_locked: AtomicBool,
}

impl StoreHealth {
    /// Notes that the writer waits for a lock, and logs a warning once a minute.
    pub(super) fn wait_for_lock(&self, waited: Duration) {
        let is_news = !self.is_locked.swap(true, Ordering::Relaxed);
        if is_news || waited.as_secs() % 60 < PATIENCE.as_secs() {
            let seconds = waited.as_secs();
            tracing::warn!(
                seconds,
                "another program holds a lock on the store; results wait until it lets go"
            );
        }
    }
}
