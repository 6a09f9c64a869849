//! The pulse of the farm's thread: whether it lives, and how long its present step has taken. It is read without a message to the thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The value for no step in progress.
const RESTING: u64 = u64::MAX;
/// The value for an ended thread.
const ENDED: u64 = u64::MAX - 1;

/// The activity of the farm's thread; clones share it.
#[derive(Debug, Clone)]
pub struct Pulse {
    began: Instant,
    /// The start of the present step, relative to `began` `[ms]`, or one of the constants above.
    step_ms: Arc<AtomicU64>,
}

/// The thread's end of a pulse. Dropping it ends the pulse, also after a panic.
#[derive(Debug)]
pub(super) struct Heart(Pulse);

impl Heart {
    /// Makes the heart of a thread that begins now.
    pub(super) fn begin() -> Heart {
        Heart(Pulse {
            began: Instant::now(),
            step_ms: Arc::new(AtomicU64::new(RESTING)),
        })
    }

    pub(super) fn pulse(&self) -> Pulse {
        self.0.clone()
    }

    /// Marks the beginning of a step.
    pub(super) fn step_begins(&self) {
        self.0.step_ms.store(self.0.age_ms(), Ordering::Relaxed);
    }

    /// Marks the end of a step.
    pub(super) fn rests(&self) {
        self.0.step_ms.store(RESTING, Ordering::Relaxed);
    }
}

impl Drop for Heart {
    fn drop(&mut self) {
        self.0.step_ms.store(ENDED, Ordering::Relaxed);
    }
}

impl Pulse {
    fn age_ms(&self) -> u64 {
        u64::try_from(self.began.elapsed().as_millis()).unwrap_or(RESTING)
    }

    /// Returns the duration of the present step, zero between two steps; `None` once the thread has ended.
    pub fn step(&self) -> Option<Duration> {
        match self.step_ms.load(Ordering::Relaxed) {
            ENDED => None,
            RESTING => Some(Duration::ZERO),
            step_ms => Some(Duration::from_millis(self.age_ms().saturating_sub(step_ms))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_lasts_until_the_thread_rests_and_an_ended_thread_has_none() {
        let heart = Heart::begin();
        let pulse = heart.pulse();
        assert_eq!(pulse.step(), Some(Duration::ZERO));
        heart.step_begins();
        while pulse.step() == Some(Duration::ZERO) {
            std::thread::yield_now();
        }
        heart.rests();
        assert_eq!(pulse.step(), Some(Duration::ZERO));
        drop(heart);
        assert_eq!(pulse.step(), None);
    }
}
