//! The cost of pilots, and the pauses after pilots that achieve nothing.

use std::collections::BTreeSet;
use std::time::Duration;

use super::pilot::Pilots;

/// The pauses after pilots that ended without a result: the first one, and the longest one. They double in between.
const PAUSES: [Duration; 2] = [Duration::from_secs(10), Duration::from_secs(600)];

/// The cost of running pilots so far.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Cost {
    thread_s: f64,
}

impl Cost {
    /// Adds the cost of some threads over a time.
    pub fn add(&mut self, threads: u64, time: Duration) {
        self.thread_s += threads as f64 * time.as_secs_f64();
    }

    /// Returns the cost so far in hours of a thread.
    pub fn thread_h(&self) -> f64 {
        self.thread_s / 3600.0
    }
}

/// The detection of futile pilots: they end while work waits and none has computed a result, as when their token is refused, their program
/// has another version, or their machine is too small.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Vain {
    /// The pilots in the previous round.
    there: BTreeSet<String>,
    /// The number of results of all pilots until then.
    computed: u64,
    pause: Option<Duration>,
    left: Duration,
}

impl Vain {
    /// Updates the state with the pilots of a round, the number of results of all pilots so far, and whether evaluations wait. Returns the
    /// pause when one begins.
    pub fn seen(
        &mut self,
        pilots: &Pilots,
        computed: u64,
        has_waiting: bool,
        elapsed: Duration,
    ) -> Option<Duration> {
        self.left = self.left.saturating_sub(elapsed);
        let there = pilots.names();
        let has_lost = !self.there.is_subset(&there);
        self.there = there;
        if std::mem::replace(&mut self.computed, computed) != computed {
            (self.pause, self.left) = (None, Duration::ZERO);
        } else if has_lost && has_waiting && self.left.is_zero() {
            let pause = self.pause.map_or(PAUSES[0], |pause| (pause * 2).min(PAUSES[1]));
            (self.pause, self.left) = (Some(pause), pause);
            return Some(pause);
        }
        None
    }

    /// Notes that pilots were cancelled, so that their absence in the next round is not counted.
    pub fn took_back(&mut self) {
        self.there.clear();
    }

    /// Returns whether pilots may be started.
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

    fn pilots(pending: &[&str], running: &[&str]) -> Pilots {
        let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
        Pilots {
            pending: owned(pending),
            running: owned(running),
        }
    }

    #[test]
    fn pilots_that_end_without_a_result_make_pauses_that_double() {
        let s = Duration::from_secs;
        let mut vain = Vain::default();
        let mut pauses = Vec::new();
        for round in 0..9 {
            assert!(vain.may_start());
            // The others still wait for a machine.
            let name = round.to_string();
            assert_eq!(vain.seen(&pilots(&["x"], &[&name]), 7, true, s(10)), None);
            let pause = vain.seen(&pilots(&["x"], &[]), 7, true, s(10)).unwrap();
            assert!(!vain.may_start());
            pauses.push(pause.as_secs());
            assert_eq!(vain.seen(&pilots(&["x"], &[]), 7, true, pause), None);
        }
        assert_eq!(pauses, [10, 20, 40, 80, 160, 320, 600, 600, 600]);
        // A result of any pilot ends the pause.
        assert_eq!(vain.seen(&pilots(&["x"], &["9"]), 8, true, s(1)), None);
        assert!(vain.may_start());
        assert_eq!(vain.seen(&pilots(&["x"], &[]), 8, true, s(1)), Some(s(10)));
    }

    #[test]
    fn pilots_may_end_where_nothing_waits_or_where_they_are_taken_back() {
        let s = Duration::from_secs;
        let mut vain = Vain {
            computed: 7,
            ..Vain::default()
        };
        assert_eq!(vain.seen(&pilots(&["2"], &["1"]), 7, true, s(10)), None);
        assert_eq!(vain.seen(&pilots(&["2"], &[]), 7, false, s(10)), None);
        vain.took_back();
        assert_eq!(vain.seen(&pilots(&[], &[]), 7, true, s(10)), None);
        assert!(vain.may_start());
    }
}
