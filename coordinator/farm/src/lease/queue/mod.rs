//! The queue of a calibration's present evaluations, and the workers that hold them.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::failure::{Claimant, Completion, Expired, LeaseFailure, MAX_UNSTARTED, NewClaim, SlowLease};

/// A time-limited claim.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Claim {
    lease: u64,
    worker: String,
    since_ms: u64,
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
    /// The workers of failed leases, which started and expired, or ended in a reported fault.
    failed: Vec<String>,
    /// The number of leases in a row that expired before they were begun.
    unstarted: u32,
    /// Whether a lease of the evaluation was lost or failed.
    suspect: bool,
    /// The workers, or voters of comparisons, that may not claim the evaluation.
    barred: Vec<String>,
    state: State,
}

impl Entry {
    fn ready(failed: Vec<String>, barred: Vec<String>) -> Entry {
        Entry {
            suspect: !failed.is_empty(),
            failed,
            unstarted: 0,
            barred,
            state: State::Ready,
        }
    }
}

/// The evaluations of a calibration's present round.
#[derive(Debug, Default)]
pub struct LeaseQueue {
    entries: BTreeMap<u64, Entry>,
    ready: VecDeque<u64>,
    suspects: VecDeque<u64>,
    leased: BTreeMap<u64, u64>,
    /// The number of leases by worker.
    held: BTreeMap<String, usize>,
}

impl LeaseQueue {
    /// Replaces the evaluations. `failed` returns the workers on which leases of an evaluation failed before a restart.
    pub fn ask(&mut self, evaluations: impl IntoIterator<Item = u64>, failed: impl Fn(u64) -> Vec<String>) {
        *self = LeaseQueue::default();
        for evaluation in evaluations {
            let entry = Entry::ready(failed(evaluation), Vec::new());
            self.queue_of(entry.suspect).push_back(evaluation);
            self.entries.insert(evaluation, entry);
        }
    }

    /// Adds an evaluation, which the barred workers may not claim.
    pub fn add(&mut self, evaluation: u64, barred: Vec<String>) {
        self.remove(evaluation);
        self.entries.insert(evaluation, Entry::ready(Vec::new(), barred));
        self.ready.push_back(evaluation);
    }

    /// Bars a voter from an evaluation, and takes back the lease of a worker of it: `is_of_voter` returns whether a worker is one.
    pub fn bar(&mut self, evaluation: u64, voter: &str, is_of_voter: impl Fn(&str) -> bool) {
        let Some(entry) = self.entries.get_mut(&evaluation) else {
            return;
        };
        entry.barred.push(voter.to_owned());
        if let State::Leased(claim) = &entry.state
            && is_of_voter(&claim.worker)
        {
            let (lease, worker) = (claim.lease, claim.worker.clone());
            self.give_back(lease, &worker);
        }
    }

    /// Lets every worker claim an evaluation.
    pub fn unbar(&mut self, evaluation: u64) {
        if let Some(entry) = self.entries.get_mut(&evaluation) {
            entry.barred.clear();
        }
    }

    /// Removes an evaluation.
    pub fn remove(&mut self, evaluation: u64) {
        self.complete(evaluation);
        self.entries.remove(&evaluation);
    }

    /// Returns the queue that an evaluation waits in.
    fn queue_of(&mut self, suspect: bool) -> &mut VecDeque<u64> {
        if suspect {
            &mut self.suspects
        } else {
            &mut self.ready
        }
    }

    /// Returns the number of evaluations that are neither leased nor done.
    pub fn unleased(&self) -> usize {
        self.ready.len() + self.suspects.len()
    }

    /// Returns the number of leases that a worker holds.
    pub fn held_by(&self, worker: &str) -> usize {
        self.held.get(worker).copied().unwrap_or(0)
    }

    /// Returns whether an evaluation is leased.
    pub fn is_leased(&self, evaluation: u64) -> bool {
        let entry = self.entries.get(&evaluation);
        entry.is_some_and(|entry| matches!(entry.state, State::Leased(_)))
    }

    /// Returns whether an evaluation is in the queue and not done.
    pub fn is_asked(&self, evaluation: u64) -> bool {
        let entry = self.entries.get(&evaluation);
        entry.is_some_and(|entry| entry.state != State::Done)
    }

    /// Removes a lease from the indices; the state of its evaluation is not changed.
    fn release(&mut self, lease: u64, worker: &str) {
        self.leased.remove(&lease);
        if let Some(held) = self.held.get_mut(worker) {
            *held -= 1;
            if *held == 0 {
                self.held.remove(worker);
            }
        }
    }

    /// Returns whether a worker holds a suspect.
    pub fn holds_suspect(&self, worker: &str) -> bool {
        self.leased.values().any(|evaluation| {
            let entry = &self.entries[evaluation];
            entry.suspect && matches!(&entry.state, State::Leased(claim) if claim.worker == worker)
        })
    }

    /// Returns whether an evaluation is a suspect.
    pub fn is_suspect(&self, evaluation: u64) -> bool {
        self.entries.get(&evaluation).is_some_and(|entry| entry.suspect)
    }

    /// Returns the number of suspects that are not leased.
    pub fn suspects(&self) -> usize {
        self.suspects.len()
    }

    /// Returns the number of leases that are out.
    pub fn leased(&self) -> usize {
        self.leased.len()
    }

    /// Returns the number of evaluations, done or not.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns the numbers of the evaluations, done or not, in order.
    pub fn asked(&self) -> Vec<u64> {
        self.entries.keys().copied().collect()
    }

    /// Returns whether the queue is empty.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Claims up to `want` evaluations.
    ///
    /// A suspect is leased alone, to a worker that holds nothing. For a worker that holds a suspect of any calibration
    /// ([`LeaseQueue::holds_suspect`]), the caller claims nothing. A worker that failed at an evaluation gets it again only if there is no
    /// other worker: `has_other` returns whether there is a worker besides those that failed.
    pub fn claim(
        &mut self,
        claimant: Claimant,
        want: usize,
        has_other: impl Fn(&[String]) -> bool,
        mut next_lease: impl FnMut() -> u64,
    ) -> Vec<NewClaim> {
        let worker = claimant.worker;
        let is_one = |names: &[String]| {
            let mut names = names.iter();
            names.any(|name| name == worker || name == claimant.voter)
        };
        let may = |evaluation: &u64| !is_one(&self.entries[evaluation].barred);
        let suits = |evaluation: &u64| {
            let failed = &self.entries[evaluation].failed;
            // A barred worker does not count as another worker.
            let others_failed = || has_other(&[&**failed, &*self.entries[evaluation].barred].concat());
            may(evaluation) && (!is_one(failed) || !others_failed())
        };
        let suspect = match claimant.holds {
            0 => self.suspects.iter().position(suits),
            _ => None,
        };
        let evaluations: Vec<u64> = match suspect {
            _ if want == 0 => Vec::new(),
            Some(place) => self.suspects.remove(place).into_iter().collect(),
            None if self.ready.iter().take(want).all(may) => {
                self.ready.drain(..want.min(self.ready.len())).collect()
            }
            None => {
                let claimed: Vec<u64> = self.ready.iter().copied().filter(|e| may(e)).take(want).collect();
                self.ready.retain(|evaluation| !claimed.contains(evaluation));
                claimed
            }
        };
        evaluations
            .into_iter()
            .map(|evaluation| {
                let lease = next_lease();
                let claim = Claim {
                    lease,
                    worker: worker.to_owned(),
                    since_ms: claimant.now_ms,
                    expires_ms: claimant.expires_ms,
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

    /// Returns how long a lease of a worker has been out `[ms]`.
    pub fn age_ms(&self, lease: u64, worker: &str, now_ms: u64) -> Option<u64> {
        let claim = self.claim_of(lease).filter(|claim| claim.worker == worker)?;
        Some(now_ms.saturating_sub(claim.since_ms))
    }

    /// Returns the lease of an evaluation that is out.
    pub fn lease_of(&self, evaluation: u64) -> Option<u64> {
        match &self.entries.get(&evaluation)?.state {
            State::Leased(claim) => Some(claim.lease),
            State::Ready | State::Done => None,
        }
    }

    /// Returns the leases that have been out for `age_ms`, the longest first, each with its evaluation.
    pub fn older_than(&self, age_ms: u64, now_ms: u64) -> impl Iterator<Item = (u64, SlowLease)> {
        self.leased.iter().filter_map(move |(lease, &evaluation)| {
            let claim = self.claim_of(*lease)?;
            let is_old = now_ms.saturating_sub(claim.since_ms) >= age_ms;
            is_old.then(|| {
                let worker = claim.worker.clone();
                (
                    evaluation,
                    SlowLease {
                        lease: *lease,
                        worker,
                    },
                )
            })
        })
    }

    fn claim_of(&self, lease: u64) -> Option<&Claim> {
        match &self.entries.get(self.leased.get(&lease)?)?.state {
            State::Leased(claim) => Some(claim),
            State::Ready | State::Done => None,
        }
    }

    /// Records that a worker has begun its leased evaluation, and extends the lease.
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

    /// Takes back the leases of some workers, which costs no attempts.
    pub fn take_back_of(&mut self, is_one: impl Fn(&str) -> bool) {
        let leases: Vec<u64> = self.leased.keys().copied().collect();
        // In this order, the lease that was given first is also the first to be leased again.
        for lease in leases.into_iter().rev() {
            let holder = self.claim_of(lease).map(|claim| claim.worker.clone());
            if let Some(worker) = holder.filter(|worker| is_one(worker)) {
                self.give_back(lease, &worker);
            }
        }
    }

    /// Takes back the leases of a worker above a number, because the answer that gave them never arrived. Returns how many.
    pub fn take_back_above(&mut self, lease: u64, worker: &str) -> u64 {
        let above = self.leased.range(lease.saturating_add(1)..);
        let lost: Vec<u64> = above
            .map(|(&lease, _)| lease)
            .filter(|&l| self.is_held_by(l, worker))
            .collect();
        // In this order, the lease that was given first is also the first to be leased again.
        lost.into_iter()
            .rev()
            .map(|lease| u64::from(self.give_back(lease, worker)))
            .sum()
    }

    /// Extends a lease of a worker. Returns `false` if the lease is no longer out, or is another worker's.
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

    /// Completes an evaluation, whether or not its lease is still out: the first valid result wins.
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
                // A replay completes evaluations in their order, so the first one is found without a search.
                if self.ready.front() == Some(&evaluation) {
                    self.ready.pop_front();
                } else {
                    self.ready.retain(|&e| e != evaluation);
                    self.suspects.retain(|&e| e != evaluation);
                }
                Completion::First
            }
        }
    }

    /// Takes back a lease that its worker returns unevaluated, which costs no attempt. Returns `false` if it is no longer out, or another
    /// worker's.
    pub fn give_back(&mut self, lease: u64, worker: &str) -> bool {
        if !self.is_held_by(lease, worker) {
            return false;
        }
        let Some((evaluation, claim)) = self.take_claim(lease) else {
            return false;
        };
        self.release(lease, &claim.worker);
        let suspect = self.entries[&evaluation].suspect;
        // It goes to the front, because evaluations that were leased earlier are needed earlier.
        self.queue_of(suspect).push_front(evaluation);
        true
    }

    /// Records the failure of a lease: the evaluation becomes a suspect.
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
        self.claim_of(lease).is_some_and(|claim| claim.worker == worker)
    }

    /// Ends a claim. Its evaluation can be leased again.
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

    /// Ends every expired lease. A started one has failed; the evaluation of any other becomes a suspect.
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
mod tests;
