//! The consequences of disagreement between workers, and second leases beside slow ones.

use std::collections::{BTreeMap, BTreeSet};

use shared::model::equations_of;

use super::farm::{Entry, Farm};
use super::replay_cause::ReplayCause;
use super::voting::{self, Voting, includes};
use super::worker_record::WorkerRecord;
use crate::calibration::{Answer, Calibration, Undecided};
use crate::lease::SlowLease;
use record::Quarantine;
use record::fact::Fact;

/// A lease is slow once its age exceeds this multiple of the mean duration of its calibration's leases plus [`SLOW_MS`].
const SLOW_TIMES: u64 = 3;
/// The fixed part of the age at which a lease is slow `[ms]`.
const SLOW_MS: u64 = 1_000;

/// At the end of a calibration, a lease for a second answer may take this multiple of the mean duration plus the duration of a lease.
const HUNG_TIMES: u64 = 10;

impl Farm {
    /// Quarantines workers that were found to compute wrongly before a restart.
    #[must_use]
    pub fn with_quarantine(mut self, quarantine: Vec<Quarantine>) -> Self {
        let reason = |q: &Quarantine| reason(&q.worker, q.calibration, q.evaluation);
        self.quarantine
            .extend(quarantine.iter().map(|q| (q.worker.clone(), reason(q))));
        self
    }

    /// Returns the calibrations to replay from the store since the last call, because results of theirs were dropped.
    pub fn take_rewinds(&mut self) -> Vec<i64> {
        std::mem::take(&mut self.rewinds)
    }

    /// Pauses a calibration whose replay failed. A user who resumes it starts another replay.
    pub fn rewind_failed(&mut self, id: i64, reason: &str) {
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return;
        };
        let message = entry.replay_cause.failure(reason);
        entry.is_replay_due = true;
        let paused = shared::api::CalibrationState::Paused;
        entry
            .calibration
            .change_state(paused, Some(message), &mut self.facts);
    }

    /// Returns the reason of a worker's quarantine, or of that of all workers of its token.
    pub(super) fn quarantined(&self, worker: &str) -> Option<&String> {
        voting::quarantined(&self.quarantine, worker)
    }

    /// Quarantines a worker that computes wrongly; with it all workers of its token, where a token counts as one. Its leases are taken
    /// back. Calibrations with results that the worker has computed or confirmed are replayed: without those that rest on quarantined
    /// workers alone, and everything in them is verified from then on.
    pub(super) fn convict(&mut self, worker: &str, calibration: i64, evaluation: u64) {
        if self.quarantined(worker).is_some() {
            return;
        }
        let convicted = self.rule.voting.voter(worker).to_owned();
        self.quarantine
            .insert(convicted.clone(), reason(&convicted, calibration, evaluation));
        let is_convicted = |worker: &str| includes(&convicted, worker);
        let workers = self.workers.keys().filter(|worker| is_convicted(worker));
        self.shut_out.extend(workers.cloned());
        let in_progress = self
            .calibrations
            .iter_mut()
            .filter(|(_, entry)| !entry.calibration.state.is_final());
        for (&id, entry) in in_progress {
            if id != calibration && !entry.calibration.witness.involves(is_convicted) {
                entry.calibration.queue.take_back_of(is_convicted);
                entry.calibration.witness.second.forget(is_convicted);
                continue;
            }
            self.facts.push(Fact::Rewound {
                calibration: id,
                worker: convicted.clone(),
                width: entry.calibration.spec.algorithm.width(),
            });
            entry.await_replay(ReplayCause::Worker);
            self.rewinds.push(id);
        }
        // This fact comes last. A crash that loses it leaves a worker that can be convicted again.
        self.facts.push(Fact::Quarantined {
            worker: convicted,
            calibration,
            evaluation,
        });
    }

    /// Settles the comparisons of a calibration that no further answer can change, and quarantines the workers that were wrong.
    pub(super) fn settle(&mut self, id: i64, now_ms: u64) {
        let since_ms = now_ms.saturating_sub(self.lease_ms);
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return;
        };
        let hung_ms = entry.hung_ms(self.lease_ms);
        let calibration = &mut entry.calibration;
        let is_open = entry.rewinds == 0 && calibration.is_open();
        if is_open && calibration.witness.second.has_comparable() {
            let voting = &self.rule.voting;
            let electorate = Electorate::new(calibration, &self.workers, &self.quarantine, voting, since_ms);
            let hung = match calibration.is_concluded() {
                true => calibration.witness.second.hung(hung_ms, now_ms),
                false => BTreeSet::new(),
            };
            let facts = calibration.settle(|evaluation, answers| match hung.contains(&evaluation) {
                true => Undecided::default(),
                false => electorate.undecided(answers),
            });
            self.keep(facts);
        }
        let entry = self.calibrations.get_mut(&id);
        let convicted = entry.map(|entry| entry.calibration.witness.take_convicted());
        for (worker, evaluation) in convicted.into_iter().flatten() {
            self.convict(&worker, id, evaluation);
        }
    }

    /// Finishes a calibration with only comparisons left, once they are made or no worker can make them.
    pub(super) fn finish_if_compared(&mut self, id: i64, now_ms: u64) {
        let since_ms = now_ms.saturating_sub(self.lease_ms);
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return;
        };
        if entry.rewinds > 0 || !entry.calibration.is_concluded() || !entry.calibration.is_open() {
            return;
        }
        let hung_ms = entry.hung_ms(self.lease_ms);
        let calibration = &mut entry.calibration;
        let voting = &self.rule.voting;
        let electorate = Electorate::new(calibration, &self.workers, &self.quarantine, voting, since_ms);
        let second = &mut calibration.witness.second;
        let hung = second.hung(hung_ms, now_ms);
        let can_answer = |answers: &[Answer]| electorate.can_answer(answers);
        self.counters.unanswered += second.drop_hopeless(can_answer, &hung);
        calibration.finish_if_compared(&mut self.facts);
    }

    /// Asks another worker for evaluations of slow leases, where nothing else waits. The first answer counts.
    pub(super) fn ask_beside_slow_workers(&mut self, now_ms: u64) {
        for entry in self.calibrations.values_mut() {
            let Entry {
                calibration, pace, ..
            } = entry;
            if !calibration.is_open() || calibration.queue.unleased() > 0 || calibration.queue.leased() == 0 {
                continue;
            }
            // Before the first result nobody knows how long an evaluation takes. A worker that renews and does not answer is helped out
            // nevertheless.
            let slow_ms = match pace.mean_lease_ms() {
                Some(mean_ms) => SLOW_TIMES * mean_ms + SLOW_MS,
                None => SLOW_MS.max(self.lease_ms),
            };
            let slow: Vec<(u64, SlowLease)> = calibration
                .queue
                .older_than(slow_ms, now_ms)
                .filter(|(e, _)| {
                    !calibration.witness.second.contains(*e) && !calibration.queue.is_suspect(*e)
                })
                .collect();
            for (evaluation, lease) in slow {
                calibration.ask_second(evaluation, Some(&lease));
            }
        }
    }
}

impl Entry {
    /// Ends all leases until the calibration is replayed, because results of it are dropped.
    pub(super) fn await_replay(&mut self, cause: ReplayCause) {
        self.replay_cause = cause;
        self.calibration.queue = Default::default();
        self.calibration.witness.second = Default::default();
        // A replay in progress has read results that are dropped now. One that is due and not in progress is this one.
        if !std::mem::take(&mut self.is_replay_due) {
            self.rewinds += 1;
        }
    }

    /// Returns the age at which a lease for a second answer is no longer waited for at the end of the calibration `[ms]`.
    fn hung_ms(&self, lease_ms: u64) -> u64 {
        HUNG_TIMES * self.pace.mean_lease_ms().unwrap_or_default() + lease_ms
    }
}

/// The workers that may answer evaluations of a calibration at present.
struct Electorate<'a> {
    able: Vec<&'a str>,
    voting: &'a Voting,
}

impl<'a> Electorate<'a> {
    /// Finds the workers that are not quarantined, have been heard of since a time, and compute the calibration's version of the model.
    fn new(
        calibration: &Calibration,
        workers: &'a BTreeMap<String, WorkerRecord>,
        quarantine: &BTreeMap<String, String>,
        voting: &'a Voting,
        since_ms: u64,
    ) -> Self {
        let version = calibration.model_version.as_deref().map(equations_of);
        let external = calibration.spec.model.external.as_ref().map(|m| m.source.name());
        let is_able = |(name, worker): &(&'a String, &WorkerRecord)| {
            let is_there = worker.last_seen_ms >= since_ms;
            let is_same = version == worker.equations_of_model(external.as_deref()).map(equations_of);
            is_there && is_same && voting::quarantined(quarantine, name).is_none()
        };
        let able = workers.iter().filter(is_able).map(|(name, _)| name.as_str());
        Electorate {
            able: able.collect(),
            voting,
        }
    }

    fn others(&self, answers: &[Answer]) -> impl Iterator<Item = &'a str> {
        let is_other = |name: &&str| {
            let voter = self.voting.voter(name);
            let mut answered = answers.iter().map(|answer| self.voting.voter(&answer.worker));
            answered.all(|answered| answered != voter)
        };
        self.able.iter().copied().filter(is_other)
    }

    /// Returns the voters that have not answered.
    fn undecided(&self, answers: &[Answer]) -> Undecided {
        let voters: BTreeSet<&str> = self.others(answers).map(|name| self.voting.voter(name)).collect();
        Undecided {
            voters: voters.len(),
            has_trusted: self.others(answers).any(|name| self.voting.trusts(name)),
        }
    }

    /// Returns whether another voter can answer.
    fn can_answer(&self, answers: &[Answer]) -> bool {
        self.others(answers).next().is_some()
    }
}

fn reason(worker: &str, calibration: i64, evaluation: u64) -> String {
    match worker.strip_suffix('/') {
        None => format!(
            "worker {worker} computes wrongly and is quarantined: its answer to evaluation {evaluation} of calibration {calibration} is contradicted; find out why, then start it anew"
        ),
        Some(token) => format!(
            "the workers of the token {token} compute wrongly and are quarantined: their answer to evaluation {evaluation} of calibration {calibration} is contradicted; find out why, then give them another token"
        ),
    }
}
