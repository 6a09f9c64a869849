//! The time that threads spend on the conditions of an evaluation that they share.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Sum of the times of the shared conditions of one evaluation.
#[derive(Debug, Default)]
pub struct SharedTime {
    spent_ns: AtomicU64,
}

impl SharedTime {
    /// Runs a part, and adds its time.
    pub(super) fn measure<T>(&self, part: impl FnOnce() -> T) -> T {
        let began = Instant::now();
        let done = part();
        let spent_ns = u64::try_from(began.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.spent_ns.fetch_add(spent_ns, Ordering::Relaxed);
        done
    }

    /// Returns the sum; `None` if no condition was shared.
    pub fn total(&self) -> Option<Duration> {
        let spent_ns = self.spent_ns.load(Ordering::Relaxed);
        (spent_ns > 0).then(|| Duration::from_nanos(spent_ns))
    }
}
