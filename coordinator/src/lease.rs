//! The rules of leasing: who may claim, renew, complete, give back; what expiry and faults cost.
//!
//! Pure: the caller brings the clock and the lease numbers. One [`LeaseQueue`] holds the evaluations of a
//! calibration that are asked for at present.
//!
//! A lost lease makes its evaluation a *suspect*: it is then leased alone, to a worker that holds nothing
//! else. So a parameter vector that kills its worker is found out, and those that were merely with it are not
//! blamed a second time.

use std::collections::{BTreeMap, VecDeque};

/// An evaluation is given up after so many failed leases.
pub const MAX_ATTEMPTS: u32 = 3;

/// A time-limited claim.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Claim {
    lease: u64,
    worker: String,
    expires_ms: u64,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum State {
    Ready,
    Leased(Claim),
    Done,
}

#[derive(Debug, Clone)]
struct Entry {
    /// Leases that failed, by expiry or by a reported fault.
    failed: u32,
    state: State,
}

/// The evaluations of one calibration that are asked for at present.
#[derive(Debug, Default)]
pub struct LeaseQueue {
    entries: BTreeMap<u64, Entry>,
    ready: VecDeque<u64>,
    suspects: VecDeque<u64>,
    leased: BTreeMap<u64, u64>,
    /// Leases out by worker.
    held: BTreeMap<String, usize>,
}

/// How a completion was received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Completion {
    /// The first valid one: it counts.
    First,
    /// Already completed: acknowledged, compared, ignored.
    Duplicate,
    /// Not asked for at present: of an earlier round, or never.
    Unknown,
}

/// A lease that failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeaseFailure {
    /// The evaluation.
    pub evaluation: u64,
    /// Who held it.
    pub worker: String,
    /// How many leases of this evaluation have failed by now.
    pub attempt: u32,
}

impl LeaseFailure {
    /// Whether the evaluation is given up.
    pub fn exhausted(&self) -> bool {
        self.attempt >= MAX_ATTEMPTS
    }
}

impl LeaseQueue {
    /// Replaces what is asked for; `failed` tells how many leases of an evaluation failed before a restart.
    pub fn ask(&mut self, evaluations: impl IntoIterator<Item = u64>, failed: impl Fn(u64) -> u32) {
        *self = LeaseQueue::default();
        for evaluation in evaluations {
            let failed = failed(evaluation);
            self.entries.insert(
                evaluation,
                Entry {
                    failed,
                    state: State::Ready,
                },
            );
            self.make_ready(evaluation, failed);
        }
    }

    fn make_ready(&mut self, evaluation: u64, failed: u32) {
        if failed > 0 {
            &mut self.suspects
        } else {
            &mut self.ready
        }
        .push_back(evaluation);
    }

    /// Evaluations that nobody holds and that are not done.
    pub fn unleased(&self) -> usize {
        self.ready.len() + self.suspects.len()
    }

    /// Leases that a worker holds.
    pub fn held_by(&self, worker: &str) -> usize {
        self.held.get(worker).copied().unwrap_or(0)
    }

    /// Takes a lease off the books; its evaluation keeps its state.
    fn release(&mut self, lease: u64, worker: &str) {
        self.leased.remove(&lease);
        if let Some(held) = self.held.get_mut(worker) {
            *held -= 1;
            if *held == 0 {
                self.held.remove(worker);
            }
        }
    }

    /// Leases that are out.
    pub fn leased(&self) -> usize {
        self.leased.len()
    }

    /// Evaluations asked for, done or not.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// The evaluations asked for, done or not, in order.
    pub fn asked(&self) -> Vec<u64> {
        self.entries.keys().copied().collect()
    }

    /// Whether nothing is asked for.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Claims up to `want` evaluations for a worker that holds `holds` leases of any calibration.
    ///
    /// A suspect goes out alone, to a worker with empty hands; a worker that holds one gets nothing else.
    pub fn claim(
        &mut self,
        worker: &str,
        want: usize,
        holds: usize,
        expires_ms: u64,
        mut next_lease: impl FnMut() -> u64,
    ) -> Vec<(u64, u64)> {
        let holds_suspect = holds > 0
            && self.leased.values().any(|evaluation| {
                let entry = &self.entries[evaluation];
                entry.failed > 0 && matches!(&entry.state, State::Leased(c) if c.worker == worker)
            });
        let evaluations: Vec<u64> = if want == 0 || holds_suspect {
            Vec::new()
        } else if !self.suspects.is_empty() && holds == 0 {
            self.suspects.pop_front().into_iter().collect()
        } else {
            self.ready.drain(..want.min(self.ready.len())).collect()
        };
        evaluations
            .into_iter()
            .map(|evaluation| {
                let lease = next_lease();
                let claim = Claim {
                    lease,
                    worker: worker.to_owned(),
                    expires_ms,
                };
                let entry = self
                    .entries
                    .get_mut(&evaluation)
                    .expect("a ready evaluation has an entry");
                entry.state = State::Leased(claim);
                self.leased.insert(lease, evaluation);
                *self.held.entry(worker.to_owned()).or_default() += 1;
                (lease, evaluation)
            })
            .collect()
    }

    /// Extends a lease of a worker; `false` where it is no longer out, or another worker's.
    pub fn renew(&mut self, lease: u64, worker: &str, until_ms: u64) -> bool {
        let Some(evaluation) = self.leased.get(&lease) else {
            return false;
        };
        match self.entries.get_mut(evaluation).map(|e| &mut e.state) {
            Some(State::Leased(claim)) if claim.worker == worker => {
                claim.expires_ms = until_ms;
                true
            }
            _ => false,
        }
    }

    /// Takes a completion, whether or not its lease is still out: the first valid one wins.
    pub fn complete(&mut self, evaluation: u64) -> Completion {
        let Some(entry) = self.entries.get_mut(&evaluation) else {
            return Completion::Unknown;
        };
        match std::mem::replace(&mut entry.state, State::Done) {
            State::Done => Completion::Duplicate,
            State::Leased(claim) => {
                self.release(claim.lease, &claim.worker);
                Completion::First
            }
            State::Ready => {
                self.ready.retain(|&e| e != evaluation);
                self.suspects.retain(|&e| e != evaluation);
                Completion::First
            }
        }
    }

    /// Takes back a lease that its worker returns unevaluated; it costs no attempt. `false` where it is no longer out, or
    /// another worker's.
    pub fn give_back(&mut self, lease: u64, worker: &str) -> bool {
        if !self.is_held_by(lease, worker) {
            return false;
        }
        let Some((evaluation, claim)) = self.take_claim(lease) else {
            return false;
        };
        self.release(lease, &claim.worker);
        let failed = self.entries[&evaluation].failed;
        // In front: what was leased earlier is waited for earlier.
        if failed > 0 {
            &mut self.suspects
        } else {
            &mut self.ready
        }
        .push_front(evaluation);
        true
    }

    /// Records the failure of a lease: the evaluation becomes a suspect, or is given up.
    pub fn fail(&mut self, lease: u64) -> Option<LeaseFailure> {
        let (evaluation, claim) = self.take_claim(lease)?;
        self.release(lease, &claim.worker);
        let entry = self.entries.get_mut(&evaluation)?;
        entry.failed += 1;
        let attempt = entry.failed;
        self.suspects.push_back(evaluation);
        Some(LeaseFailure {
            evaluation,
            worker: claim.worker,
            attempt,
        })
    }

    fn is_held_by(&self, lease: u64, worker: &str) -> bool {
        let entry = self
            .leased
            .get(&lease)
            .map(|evaluation| &self.entries[evaluation]);
        entry.is_some_and(|entry| matches!(&entry.state, State::Leased(claim) if claim.worker == worker))
    }

    /// Ends a claim; its evaluation is ready again.
    fn take_claim(&mut self, lease: u64) -> Option<(u64, Claim)> {
        let evaluation = *self.leased.get(&lease)?;
        let entry = self.entries.get_mut(&evaluation)?;
        match std::mem::replace(&mut entry.state, State::Ready) {
            State::Leased(claim) => Some((evaluation, claim)),
            other => {
                entry.state = other;
                None
            }
        }
    }

    /// Fails every lease whose time has come.
    pub fn expire(&mut self, now_ms: u64) -> Vec<LeaseFailure> {
        let due: Vec<u64> = self
            .leased
            .iter()
            .filter(|(_, evaluation)| {
                matches!(&self.entries[evaluation].state, State::Leased(c) if c.expires_ms <= now_ms)
            })
            .map(|(&lease, _)| lease)
            .collect();
        due.into_iter().filter_map(|lease| self.fail(lease)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn queue(evaluations: u64) -> LeaseQueue {
        let mut queue = LeaseQueue::default();
        queue.ask(0..evaluations, |_| 0);
        queue
    }

    fn claim(queue: &mut LeaseQueue, worker: &str, want: usize, holds: usize, first: u64) -> Vec<(u64, u64)> {
        let mut next = first;
        queue.claim(worker, want, holds, 100, || {
            next += 1;
            next
        })
    }

    #[test]
    fn a_late_completion_counts_once() {
        let mut queue = queue(1);
        claim(&mut queue, "a", 1, 0, 0);
        assert_eq!(queue.expire(100).len(), 1);
        assert_eq!(queue.complete(0), Completion::First);
        assert_eq!(queue.complete(0), Completion::Duplicate);
        assert_eq!(queue.complete(7), Completion::Unknown);
        assert_eq!(queue.unleased(), 0);
    }

    #[test]
    fn a_lost_batch_comes_back_one_by_one_and_only_to_empty_hands() {
        let mut queue = queue(3);
        assert_eq!(claim(&mut queue, "a", 3, 0, 0).len(), 3);
        assert_eq!(queue.expire(100).len(), 3);
        assert_eq!(claim(&mut queue, "b", 3, 1, 10), vec![]);
        assert_eq!(claim(&mut queue, "b", 3, 0, 10), vec![(11, 0)]);
        assert_eq!(claim(&mut queue, "b", 3, 1, 20), vec![]);
    }

    #[test]
    fn an_evaluation_that_kills_its_workers_is_given_up_at_the_third_attempt() {
        let mut queue = queue(1);
        for attempt in 1..=3 {
            let lease = claim(&mut queue, "a", 1, 0, attempt * 10)[0].0;
            let failure = queue.fail(lease).unwrap();
            assert_eq!(
                (failure.attempt, failure.exhausted()),
                (attempt as u32, attempt == 3)
            );
        }
    }

    #[test]
    fn a_returned_lease_costs_no_attempt() {
        let mut queue = queue(2);
        let leases = claim(&mut queue, "a", 2, 0, 0);
        assert!(!queue.give_back(leases[1].0, "b"), "not its own");
        assert!(queue.give_back(leases[1].0, "a"));
        assert!(!queue.give_back(leases[1].0, "a"));
        assert_eq!(claim(&mut queue, "b", 5, 0, 10), vec![(11, 1)]);
    }

    #[test]
    fn a_renewed_lease_outlives_its_first_time() {
        let mut queue = queue(1);
        let lease = claim(&mut queue, "a", 1, 0, 0)[0].0;
        assert!(!queue.renew(lease, "b", 300), "not its own");
        assert!(queue.renew(lease, "a", 200));
        assert!(queue.expire(100).is_empty());
        assert_eq!(queue.expire(200).len(), 1);
        assert!(!queue.renew(lease, "a", 300));
    }

    proptest! {
        /// Whatever happens in whatever order, no evaluation is held twice, none is lost, each completes once.
        #[test]
        fn random_histories_lose_nothing(steps in prop::collection::vec((0u8..5, 0u64..12), 1..200)) {
            let mut queue = queue(12);
            let (mut next, mut now) = (0u64, 0u64);
            let mut out: Vec<(u64, u64)> = Vec::new();
            let mut completed = std::collections::BTreeSet::new();
            for (action, target) in steps {
                match action {
                    0 => {
                        let new = queue.claim("w", (target % 4) as usize + 1, 0, now + 5, || { next += 1; next });
                        for (_, evaluation) in &new {
                            prop_assert!(!completed.contains(evaluation));
                        }
                        out.extend(new);
                    }
                    1 => {
                        let first = queue.complete(target) == Completion::First;
                        prop_assert_eq!(first, completed.insert(target));
                    }
                    2 => { if let Some(&(lease, _)) = out.first() { queue.give_back(lease, "w"); out.remove(0); } }
                    3 => { if let Some(&(lease, _)) = out.last() { queue.fail(lease); out.pop(); } }
                    _ => { now += target; queue.expire(now); }
                }
                prop_assert_eq!(queue.unleased() + queue.leased() + completed.len(), 12);
            }
        }
    }
}
