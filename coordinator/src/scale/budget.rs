//! What pilots have cost, and when starting more is in vain.

use std::time::Duration;

/// The pauses after pilots that ended before the service heard of a worker: they double, from the first to the last.
const PAUSES: [Duration; 2] = [Duration::from_secs(10), Duration::from_secs(600)];

/// The cost of running pilots, against its cap.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Cost {
    thread_s: f64,
}

impl Cost {
    /// Adds the cost of so many threads over a time.
    pub fn add(&mut self, threads: u64, time: Duration) {
        self.thread_s += threads as f64 * time.as_secs_f64();
    }

    /// Hours of a thread so far.
    pub fn thread_h(&self) -> f64 {
        self.thread_s / 3600.0
    }
}

/// Notices pilots that end without ever having worked, as where their token is refused.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Vain {
    is_waiting: bool,
    pause: Option<Duration>,
    left: Duration,
}

impl Vain {
    /// Pilots have been asked for.
    pub fn started(&mut self) {
        self.is_waiting = true;
    }

    /// What is seen after another while: whether the service knows a worker, and whether a pilot is there. Says the pause when one begins.
    pub fn seen(&mut self, knows_worker: bool, has_pilot: bool, elapsed: Duration) -> Option<Duration> {
        self.left = self.left.saturating_sub(elapsed);
        if knows_worker {
            *self = Vain::default();
        } else if self.is_waiting && !has_pilot {
            self.is_waiting = false;
            let pause = self.pause.map_or(PAUSES[0], |pause| (pause * 2).min(PAUSES[1]));
            (self.pause, self.left) = (Some(pause), pause);
            return Some(pause);
        }
        None
    }

    /// Whether pilots may be started.
    pub fn may_start(&self) -> bool {
        self.left.is_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cost_adds_up() {
        let mut cost = Cost::default();
        cost.add(8, Duration::from_secs(1800));
        cost.add(2, Duration::from_secs(900));
        assert!((cost.thread_h() - 4.5).abs() < 1e-12);
    }

    #[test]
    fn pilots_that_end_without_a_word_make_pauses_that_double() {
        let s = Duration::from_secs;
        let mut vain = Vain::default();
        let mut pauses = Vec::new();
        for _ in 0..9 {
            assert!(vain.may_start());
            vain.started();
            assert_eq!(vain.seen(false, true, s(10)), None);
            let pause = vain.seen(false, false, s(10)).unwrap();
            assert!(!vain.may_start());
            pauses.push(pause.as_secs());
            assert_eq!(vain.seen(false, false, pause), None);
        }
        assert_eq!(pauses, [10, 20, 40, 80, 160, 320, 600, 600, 600]);
        vain.started();
        assert_eq!(vain.seen(true, true, s(10)), None);
        assert_eq!(vain, Vain::default());
    }
}
