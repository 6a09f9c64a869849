//! The rules of leasing: who may claim, renew, complete, give back; what expiry and faults cost.
//!
//! Pure: the caller brings the clock and the lease numbers. One [`LeaseQueue`] holds the evaluations of a
//! calibration that are asked for at present.
//!
//! A lost lease makes its evaluation a *suspect*: it is then leased alone, to a worker that holds nothing else and
//! reports that it begins before it does. So a parameter vector that kills its worker is found out, and those that were
//! merely with it are not blamed. Only the loss of a lease that was reported as started is a failed attempt: whoever dies,
//! or is cut off, has done nothing to the evaluations that wait in its hands. An evaluation that is lost twenty times in a row
//! before anybody begins it is told to the caller: whatever ends its workers, leasing it on ends more of them.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// An evaluation is given up after so many failed leases.
pub const MAX_ATTEMPTS: u32 = 3;

/// A calibration pauses after an evaluation was leased so often in a row without being begun.
pub const MAX_UNSTARTED: u32 = 20;

/// A time-limited claim.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Claim {
    lease: u64,
    worker: String,
    expires_ms: u64,
    /// Whether its worker has reported that the evaluation began.
    started: bool,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum State {
    Ready,
    Leased(Claim),
    Done,
}

#[derive(Debug, Clone)]
struct Entry {
    /// The workers of the leases that failed: started and expired, or ended in a reported fault.
    failed: Vec<String>,
    /// Leases in a row that expired before they were begun.
    unstarted: u32,
    /// Whether a lease of it was lost or failed.
    suspect: bool,
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
    /// On how many different workers.
    pub workers: usize,
}

/// A claim on an evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NewClaim {
    /// The lease.
    pub lease: u64,
    /// The evaluation.
    pub evaluation: u64,
    /// Whether it is a suspect, whose start must be reported.
    pub suspect: bool,
}

/// What the passing of time has ended.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Expired {
    /// Started leases: failed attempts.
    pub failures: Vec<LeaseFailure>,
    /// How many leases expired that nobody had started.
    pub unstarted: u64,
    /// Evaluations that were leased [`MAX_UNSTARTED`] times in a row without being begun.
    pub never_begun: Vec<u64>,
}

impl LeaseFailure {
    /// Whether the evaluation is tried no more.
    pub fn exhausted(&self) -> bool {
        self.attempt >= MAX_ATTEMPTS
    }

    /// Whether so many different workers failed that the evaluation, not a machine, is at fault.
    pub fn is_evaluations_own(&self) -> bool {
        self.workers >= MAX_ATTEMPTS as usize
    }
}

impl LeaseQueue {
    /// Replaces what is asked for; `failed` tells on which workers leases of an evaluation failed before a restart.
    pub fn ask(&mut self, evaluations: impl IntoIterator<Item = u64>, failed: impl Fn(u64) -> Vec<String>) {
        *self = LeaseQueue::default();
        for evaluation in evaluations {
            let failed = failed(evaluation);
            let suspect = !failed.is_empty();
            let state = State::Ready;
            self.entries.insert(
                evaluation,
                Entry {
                    failed,
                    unstarted: 0,
                    suspect,
                    state,
                },
            );
            self.queue_of(suspect).push_back(evaluation);
        }
    }

    /// Where an evaluation waits.
    fn queue_of(&mut self, suspect: bool) -> &mut VecDeque<u64> {
        if suspect {
            &mut self.suspects
        } else {
            &mut self.ready
        }
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

    /// Whether a worker holds a suspect.
    pub fn holds_suspect(&self, worker: &str) -> bool {
        self.leased.values().any(|evaluation| {
            let entry = &self.entries[evaluation];
            entry.suspect && matches!(&entry.state, State::Leased(claim) if claim.worker == worker)
        })
    }

    /// Suspects that nobody holds.
    pub fn suspects(&self) -> usize {
        self.suspects.len()
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
    /// A suspect goes out alone, to a worker with empty hands; for a worker that holds one ([`LeaseQueue::holds_suspect`]), of any
    /// calibration, the caller claims nothing. A worker that failed at it gets it again only if there is no other: `has_other`
    /// tells whether a worker is there that is not among those that failed.
    pub fn claim(
        &mut self,
        worker: &str,
        want: usize,
        holds: usize,
        expires_ms: u64,
        has_other: impl Fn(&[String]) -> bool,
        mut next_lease: impl FnMut() -> u64,
    ) -> Vec<NewClaim> {
        let suits = |evaluation: &u64| {
            let failed = &self.entries[evaluation].failed;
            !failed.iter().any(|name| name == worker) || !has_other(failed)
        };
        let suspect = match holds {
            0 => self.suspects.iter().position(suits),
            _ => None,
        };
        let evaluations: Vec<u64> = match suspect {
            _ if want == 0 => Vec::new(),
            Some(place) => self.suspects.remove(place).into_iter().collect(),
            None => self.ready.drain(..want.min(self.ready.len())).collect(),
        };
        evaluations
            .into_iter()
            .map(|evaluation| {
                let lease = next_lease();
                let claim = Claim {
                    lease,
                    worker: worker.to_owned(),
                    expires_ms,
                    started: false,
                };
                let entry = self
                    .entries
                    .get_mut(&evaluation)
                    .expect("a ready evaluation has an entry");
                entry.state = State::Leased(claim);
                self.leased.insert(lease, evaluation);
                let suspect = entry.suspect;
                *self.held.entry(worker.to_owned()).or_default() += 1;
                NewClaim {
                    lease,
                    evaluation,
                    suspect,
                }
            })
            .collect()
    }

    /// Notes that a worker has begun to evaluate a lease of its own, and extends the lease.
    pub fn start(&mut self, lease: u64, worker: &str, until_ms: u64) -> bool {
        let held = self.renew(lease, worker, until_ms);
        let evaluation = self.leased.get(&lease).filter(|_| held);
        if let Some(entry) = evaluation.and_then(|e| self.entries.get_mut(e))
            && let State::Leased(claim) = &mut entry.state
        {
            claim.started = true;
            entry.unstarted = 0;
        }
        held
    }

    /// Takes back the leases of some workers, at no cost.
    pub fn take_back_of(&mut self, is_one: impl Fn(&str) -> bool) {
        let leases: Vec<u64> = self.leased.keys().copied().collect();
        // The first given is the first to go out again.
        for lease in leases.into_iter().rev() {
            let holder = self
                .leased
                .get(&lease)
                .map(|evaluation| &self.entries[evaluation].state);
            if let Some(State::Leased(claim)) = holder
                && is_one(&claim.worker)
            {
                let worker = claim.worker.clone();
                self.give_back(lease, &worker);
            }
        }
    }

    /// Takes back the leases of a worker above a number: the answer that gave them never arrived. How many.
    pub fn take_back_above(&mut self, lease: u64, worker: &str) -> u64 {
        let above = self.leased.range(lease.saturating_add(1)..);
        let lost: Vec<u64> = above
            .map(|(&lease, _)| lease)
            .filter(|&l| self.is_held_by(l, worker))
            .collect();
        // The first given is the first to go out again.
        lost.into_iter()
            .rev()
            .map(|lease| u64::from(self.give_back(lease, worker)))
            .sum()
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
        let suspect = self.entries[&evaluation].suspect;
        // In front: what was leased earlier is waited for earlier.
        self.queue_of(suspect).push_front(evaluation);
        true
    }

    /// Records the failure of a lease: the evaluation becomes a suspect, or is given up.
    pub fn fail(&mut self, lease: u64) -> Option<LeaseFailure> {
        let (evaluation, claim) = self.take_claim(lease)?;
        self.release(lease, &claim.worker);
        let entry = self.entries.get_mut(&evaluation)?;
        entry.failed.push(claim.worker.clone());
        entry.suspect = true;
        let attempt = entry.failed.len() as u32;
        let workers = entry.failed.iter().collect::<BTreeSet<_>>().len();
        self.suspects.push_back(evaluation);
        Some(LeaseFailure {
            evaluation,
            worker: claim.worker,
            attempt,
            workers,
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

    /// Ends every lease whose time has come: a started one has failed, of another the evaluation becomes a suspect.
    pub fn expire(&mut self, now_ms: u64) -> Expired {
        let mut due: Vec<(u64, bool)> = Vec::new();
        for (&lease, evaluation) in &self.leased {
            match &self.entries[evaluation].state {
                State::Leased(claim) if claim.expires_ms <= now_ms => due.push((lease, claim.started)),
                _ => {}
            }
        }
        let mut expired = Expired::default();
        for (lease, started) in due {
            if started {
                expired.failures.extend(self.fail(lease));
            } else if let Some((evaluation, claim)) = self.take_claim(lease) {
                self.release(lease, &claim.worker);
                if let Some(entry) = self.entries.get_mut(&evaluation) {
                    entry.suspect = true;
                    entry.unstarted += 1;
                    if entry.unstarted.is_multiple_of(MAX_UNSTARTED) {
                        expired.never_begun.push(evaluation);
                    }
                }
                self.suspects.push_back(evaluation);
                expired.unstarted += 1;
            }
        }
        expired
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn queue(evaluations: u64) -> LeaseQueue {
        let mut queue = LeaseQueue::default();
        queue.ask(0..evaluations, |_| Vec::new());
        queue
    }

    /// Claims for the only worker there is.
    fn claim(queue: &mut LeaseQueue, worker: &str, want: usize, holds: usize, first: u64) -> Vec<(u64, u64)> {
        claim_beside(queue, worker, want, holds, first, &[])
    }

    fn claim_beside(
        queue: &mut LeaseQueue,
        worker: &str,
        want: usize,
        holds: usize,
        first: u64,
        others: &[&str],
    ) -> Vec<(u64, u64)> {
        let mut next = first;
        let has_other = |failed: &[String]| others.iter().any(|other| !failed.iter().any(|f| f == other));
        let claims = queue.claim(worker, want, holds, 100, has_other, || {
            next += 1;
            next
        });
        claims
            .iter()
            .map(|claim| (claim.lease, claim.evaluation))
            .collect()
    }

    #[test]
    fn a_late_completion_counts_once() {
        let mut queue = queue(1);
        claim(&mut queue, "a", 1, 0, 0);
        assert_eq!(queue.expire(100).unstarted, 1);
        assert_eq!(queue.complete(0), Completion::First);
        assert_eq!(queue.complete(0), Completion::Duplicate);
        assert_eq!(queue.complete(7), Completion::Unknown);
        assert_eq!(queue.unleased(), 0);
    }

    #[test]
    fn a_lost_batch_comes_back_one_by_one_and_only_to_empty_hands_and_costs_what_had_begun() {
        let mut queue = queue(3);
        let leases = claim(&mut queue, "a", 3, 0, 0);
        assert!(!queue.start(leases[1].0, "b", 100), "not its own");
        assert!(queue.start(leases[1].0, "a", 100));
        let expired = queue.expire(100);
        let failed: Vec<(u64, u32)> = expired
            .failures
            .iter()
            .map(|f| (f.evaluation, f.attempt))
            .collect();
        assert_eq!((failed, expired.unstarted), (vec![(1, 1)], 2));
        assert_eq!(claim(&mut queue, "b", 3, 1, 10), vec![]);
        assert_eq!(claim(&mut queue, "b", 3, 0, 10), vec![(11, 0)]);
        assert!(queue.holds_suspect("b") && !queue.holds_suspect("a"));
    }

    #[test]
    fn leases_of_an_answer_that_never_arrived_come_back_at_no_cost() {
        let mut queue = queue(6);
        let received = claim(&mut queue, "a", 2, 0, 0)[1].0;
        claim(&mut queue, "b", 1, 0, 10);
        claim(&mut queue, "a", 3, 2, 20);
        assert_eq!(queue.take_back_above(received, "a"), 3);
        assert_eq!(queue.take_back_above(received, "a"), 0);
        assert_eq!(queue.leased(), 3);
        let again: Vec<u64> = claim(&mut queue, "c", 6, 0, 30).iter().map(|c| c.1).collect();
        assert_eq!(again, [3, 4, 5], "in their order, and no suspects");
    }

    #[test]
    fn an_evaluation_that_kills_its_workers_is_given_up_at_the_third_attempt() {
        for names in [["a", "b", "c"], ["a", "a", "b"]] {
            let mut queue = queue(1);
            for (k, name) in names.into_iter().enumerate() {
                let lease = claim(&mut queue, name, 1, 0, 10 * k as u64)[0].0;
                let failure = queue.fail(lease).unwrap();
                assert_eq!((failure.attempt, failure.exhausted()), (k as u32 + 1, k == 2));
                assert_eq!(failure.is_evaluations_own(), k == 2 && names[1] == "b");
            }
        }
    }

    #[test]
    fn a_worker_gets_what_it_failed_at_again_only_if_there_is_no_other() {
        let mut queue = queue(1);
        let lease = claim(&mut queue, "a", 1, 0, 0)[0].0;
        queue.fail(lease);
        assert_eq!(claim_beside(&mut queue, "a", 1, 0, 10, &["a", "b"]), vec![]);
        assert_eq!(claim_beside(&mut queue, "a", 1, 0, 10, &["a"]), vec![(11, 0)]);
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
    fn an_evaluation_that_nobody_begins_is_told_after_twenty_leases_in_a_row() {
        let mut queue = queue(1);
        for begun in [true, false] {
            for lost in 1..=MAX_UNSTARTED {
                let lease = claim(&mut queue, "a", 1, 0, u64::from(lost))[0].0;
                if begun && lost == 10 {
                    assert!(queue.start(lease, "a", 100));
                    queue.give_back(lease, "a");
                } else {
                    let told = queue.expire(100).never_begun;
                    assert_eq!(told.len(), usize::from(!begun && lost == 10), "{lost}");
                }
            }
        }
    }

    #[test]
    fn leases_of_some_workers_come_back_at_no_cost() {
        let mut queue = queue(4);
        claim(&mut queue, "a", 1, 0, 0);
        claim(&mut queue, "b", 2, 0, 10);
        queue.take_back_of(|worker| worker == "b");
        assert_eq!((queue.leased(), queue.held_by("b")), (1, 0));
        let again: Vec<u64> = claim(&mut queue, "c", 4, 0, 20).iter().map(|c| c.1).collect();
        assert_eq!(again, [1, 2, 3], "in their order, and no suspects");
    }

    #[test]
    fn a_renewed_lease_outlives_its_first_time() {
        let mut queue = queue(1);
        let lease = claim(&mut queue, "a", 1, 0, 0)[0].0;
        assert!(!queue.renew(lease, "b", 300), "not its own");
        assert!(queue.renew(lease, "a", 200));
        assert_eq!(queue.expire(100), Expired::default());
        assert_eq!(queue.expire(200).unstarted, 1);
        assert!(!queue.renew(lease, "a", 300));
    }

    proptest! {
        /// Whatever happens in whatever order, no evaluation is held twice, none is lost, each completes once.
        #[test]
        fn random_histories_lose_nothing(steps in prop::collection::vec((0u8..7, 0u64..12), 1..200)) {
            let mut queue = queue(12);
            let (mut next, mut now) = (0u64, 0u64);
            let mut out: Vec<(u64, u64)> = Vec::new();
            let mut completed = std::collections::BTreeSet::new();
            for (action, target) in steps {
                match action {
                    0 => {
                        let new = queue.claim("w", (target % 4) as usize + 1, 0, now + 5, |_| false, || { next += 1; next });
                        for claim in &new {
                            prop_assert!(!completed.contains(&claim.evaluation));
                        }
                        out.extend(new.iter().map(|claim| (claim.lease, claim.evaluation)));
                    }
                    1 => {
                        let first = queue.complete(target) == Completion::First;
                        prop_assert_eq!(first, completed.insert(target));
                    }
                    2 => { if let Some(&(lease, _)) = out.first() { queue.give_back(lease, "w"); out.remove(0); } }
                    3 => { if let Some(&(lease, _)) = out.last() { queue.fail(lease); out.pop(); } }
                    4 => { if let Some(&(lease, _)) = out.last() { queue.start(lease, "w", now + 5); } }
                    5 => { queue.take_back_above(next.saturating_sub(target), "w"); }
                    _ => { now += target; queue.expire(now); }
                }
                prop_assert_eq!(queue.unleased() + queue.leased() + completed.len(), 12);
            }
        }
    }
}
