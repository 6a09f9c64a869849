//! The evaluations of one calibration that are asked for at present, and who holds them.

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
    /// The workers of the leases that failed: started and expired, or ended in a reported fault.
    failed: Vec<String>,
    /// Leases in a row that expired before they were begun.
    unstarted: u32,
    /// Whether a lease of it was lost or failed.
    suspect: bool,
    /// The workers that may not claim it.
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

impl LeaseQueue {
    /// Replaces what is asked for; `failed` tells on which workers leases of an evaluation failed before a restart.
    pub fn ask(&mut self, evaluations: impl IntoIterator<Item = u64>, failed: impl Fn(u64) -> Vec<String>) {
        *self = LeaseQueue::default();
        for evaluation in evaluations {
            let entry = Entry::ready(failed(evaluation), Vec::new());
            self.queue_of(entry.suspect).push_back(evaluation);
            self.entries.insert(evaluation, entry);
        }
    }

    /// Asks for one evaluation more, which some workers may not claim.
    pub fn add(&mut self, evaluation: u64, barred: Vec<String>) {
        self.remove(evaluation);
        self.entries.insert(evaluation, Entry::ready(Vec::new(), barred));
        self.ready.push_back(evaluation);
    }

    /// Keeps a worker from claiming an evaluation, and takes its lease of it back.
    pub fn bar(&mut self, evaluation: u64, worker: &str) {
        let Some(entry) = self.entries.get_mut(&evaluation) else {
            return;
        };
        entry.barred.push(worker.to_owned());
        if let State::Leased(claim) = &entry.state
            && claim.worker == worker
        {
            let lease = claim.lease;
            self.give_back(lease, worker);
        }
    }

    /// Lets every worker claim an evaluation.
    pub fn unbar(&mut self, evaluation: u64) {
        if let Some(entry) = self.entries.get_mut(&evaluation) {
            entry.barred.clear();
        }
    }

    /// Asks for an evaluation no more.
    pub fn remove(&mut self, evaluation: u64) {
        self.complete(evaluation);
        self.entries.remove(&evaluation);
    }

    /// The queue that an evaluation waits in.
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

    /// Whether somebody holds an evaluation.
    pub fn is_leased(&self, evaluation: u64) -> bool {
        let entry = self.entries.get(&evaluation);
        entry.is_some_and(|entry| matches!(entry.state, State::Leased(_)))
    }

    /// Whether an evaluation is asked for and not done.
    pub fn is_asked(&self, evaluation: u64) -> bool {
        let entry = self.entries.get(&evaluation);
        entry.is_some_and(|entry| entry.state != State::Done)
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

    /// Whether an evaluation is a suspect.
    pub fn is_suspect(&self, evaluation: u64) -> bool {
        self.entries.get(&evaluation).is_some_and(|entry| entry.suspect)
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

    /// Claims up to `want` evaluations.
    ///
    /// A suspect goes out alone, to a worker with empty hands; for a worker that holds one ([`LeaseQueue::holds_suspect`]), of any
    /// calibration, the caller claims nothing. A worker that failed at it gets it again only if there is no other: `has_other`
    /// tells whether a worker is there that is not among those that failed.
    pub fn claim(
        &mut self,
        claimant: Claimant,
        want: usize,
        has_other: impl Fn(&[String]) -> bool,
        mut next_lease: impl FnMut() -> u64,
    ) -> Vec<NewClaim> {
        let worker = claimant.worker;
        let is_one = |names: &[String]| names.iter().any(|name| name == worker);
        let may = |evaluation: &u64| !is_one(&self.entries[evaluation].barred);
        let suits = |evaluation: &u64| {
            let failed = &self.entries[evaluation].failed;
            // A worker that may not claim the evaluation is no other worker for it.
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

    /// How long a lease of a worker has been out `[ms]`.
    pub fn age_ms(&self, lease: u64, worker: &str, now_ms: u64) -> Option<u64> {
        let claim = self.claim_of(lease).filter(|claim| claim.worker == worker)?;
        Some(now_ms.saturating_sub(claim.since_ms))
    }

    /// The lease of an evaluation that is out.
    pub fn lease_of(&self, evaluation: u64) -> Option<u64> {
        match &self.entries.get(&evaluation)?.state {
            State::Leased(claim) => Some(claim.lease),
            State::Ready | State::Done => None,
        }
    }

    /// The leases that have been out for so long `[ms]`, the longest first, each with its evaluation.
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
            let holder = self.claim_of(lease).map(|claim| claim.worker.clone());
            if let Some(worker) = holder.filter(|worker| is_one(worker)) {
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
                // A replay completes what is asked for in its order: no queue is searched for the first of it.
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
        self.claim_of(lease).is_some_and(|claim| claim.worker == worker)
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
mod tests;
