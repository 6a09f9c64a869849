//! The policy that determines the number of pilots from the waiting work.

use std::time::Duration;

use shared::api::WorkDemand;

/// Bounds and aims of the policy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Policy {
    /// The smallest number of pilots.
    pub min: u32,
    /// The largest number of pilots.
    pub max: u32,
    /// The number of threads of a pilot.
    pub threads: u32,
    /// The time in which the remaining work should be finished `[s]`.
    pub finish_within_s: f64,
}

impl Policy {
    /// Returns the wanted number of pilots.
    ///
    /// n = ⌈min(W τ / t, Q) / k⌉ within [min, max], with W evaluations left of τ seconds each, the time t in which they should be finished,
    /// Q evaluations that wait or are leased, which limits the number of busy threads, and k threads of a pilot.
    ///
    /// While τ is unknown, one pilot measures it. Between two rounds of a calibration, where Q = 0, the number of pilots stays, because the
    /// next round follows as soon as the sampler has proposed it. Test: `the_work_left_decides_within_bounds`.
    pub fn wanted(&self, demand: &WorkDemand, present: u32) -> u32 {
        let at_once = demand.queued + demand.leased;
        let wanted = match (demand.in_hand, at_once, demand.evaluation_s) {
            (0, _, _) => 0,
            (_, 0, _) => present.max(1),
            (_, _, None) => present.max(1),
            (_, at_once, Some(evaluation_s)) => {
                let work_s = demand.evaluations_left.max(at_once) as f64 * evaluation_s;
                let threads = (work_s / self.finish_within_s).min(at_once as f64);
                (threads / f64::from(self.threads)).ceil().max(1.0) as u32
            }
        };
        wanted.max(self.min).min(self.max)
    }
}

/// A delay that keeps pilots at the end of a round, where few evaluations are left, for the next round.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Patience {
    fewer_for: Duration,
}

impl Patience {
    /// Returns the delayed number of pilots. It falls below the present number only after it has been wanted for `patience`, or without a
    /// calibration in progress.
    pub fn wanted(
        &mut self,
        wanted: u32,
        present: u32,
        has_calibration: bool,
        elapsed: Duration,
        patience: Duration,
    ) -> u32 {
        if wanted >= present || !has_calibration {
            *self = Patience::default();
            return wanted;
        }
        self.fewer_for += elapsed;
        if self.fewer_for < patience {
            present
        } else {
            wanted
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POLICY: Policy = Policy {
        min: 0,
        max: 200,
        threads: 4,
        finish_within_s: 100.0,
    };

    fn demand(queued: u64, left: u64, evaluation_s: Option<f64>) -> WorkDemand {
        WorkDemand {
            queued,
            leased: 0,
            evaluations_left: left,
            in_hand: 1,
            workers: 0,
            threads: 0,
            evaluation_s,
            completed_in_queues: 0,
        }
    }

    #[test]
    fn the_work_left_decides_within_bounds() {
        // 10,000 evaluations of 1 s in 100 s want 100 threads: 25 pilots of four
        assert_eq!(POLICY.wanted(&demand(5000, 10_000, Some(1.0)), 0), 25);
        // there are no more threads than evaluations that can run at once
        assert_eq!(POLICY.wanted(&demand(40, 10_000, Some(1.0)), 0), 10);
        // quick work needs one pilot
        assert_eq!(POLICY.wanted(&demand(5000, 5000, Some(1e-5)), 0), 1);
        assert_eq!(POLICY.wanted(&demand(1 << 40, 1 << 50, Some(1e6)), 0), 200);
    }

    #[test]
    fn a_first_pilot_finds_out_how_long_an_evaluation_takes() {
        assert_eq!(POLICY.wanted(&demand(5000, 5000, None), 0), 1);
        assert_eq!(POLICY.wanted(&demand(5000, 5000, None), 7), 7);
    }

    #[test]
    fn pilots_stay_between_rounds_and_go_when_nothing_is_in_hand() {
        assert_eq!(POLICY.wanted(&demand(0, 0, Some(1.0)), 12), 12);
        let nothing = WorkDemand {
            in_hand: 0,
            ..demand(0, 0, Some(1.0))
        };
        assert_eq!(POLICY.wanted(&nothing, 12), 0);
        let kept = Policy { min: 3, ..POLICY };
        assert_eq!(kept.wanted(&nothing, 12), 3);
    }

    #[test]
    fn the_end_of_a_round_takes_no_pilots_back() {
        let s = Duration::from_secs;
        let mut patience = Patience::default();
        assert_eq!(patience.wanted(5, 20, true, s(100), s(120)), 20);
        assert_eq!(patience.wanted(25, 20, true, s(100), s(120)), 25);
        assert_eq!(patience.wanted(5, 25, true, s(60), s(120)), 25);
        assert_eq!(patience.wanted(5, 25, true, s(60), s(120)), 5);
        assert_eq!(patience.wanted(0, 25, false, s(1), s(120)), 0);
    }

    #[test]
    fn none_at_most_is_none() {
        let none = Policy { max: 0, ..POLICY };
        assert_eq!(none.wanted(&demand(5000, 5000, Some(1.0)), 0), 0);
    }
}
