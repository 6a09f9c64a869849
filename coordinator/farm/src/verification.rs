//! The consequences of disagreement between workers, and second leases beside slow ones.

use shared::model::equations_of;

use super::farm::{Entry, Farm};
use crate::calibration::Answer;
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
        let message = format!(
            "results of a worker that computes wrongly were dropped, but the rest cannot be replayed: {reason}"
        );
        entry.is_replay_due = true;
        let paused = shared::api::CalibrationState::Paused;
        entry
            .calibration
            .change_state(paused, Some(message), &mut self.facts);
    }

    /// Quarantines a worker that computes wrongly. Its leases are taken back, and calibrations with unconfirmed results of the worker are
    /// replayed without them.
    pub(super) fn convict(&mut self, worker: &str, calibration: i64, evaluation: u64) {
        if self.quarantine.contains_key(worker) {
            return;
        }
        self.quarantine
            .insert(worker.to_owned(), reason(worker, calibration, evaluation));
        let in_progress = self
            .calibrations
            .iter_mut()
            .filter(|(_, entry)| !entry.calibration.state.is_final());
        for (&id, entry) in in_progress {
            let rests = entry.calibration.witness.rests_on(worker);
            if !rests {
                entry.calibration.queue.take_back_of(|name| name == worker);
                entry.calibration.witness.second.forget(worker);
            }
            if rests || id == calibration {
                self.facts.push(Fact::Rewound {
                    calibration: id,
                    worker: worker.to_owned(),
                    width: entry.calibration.spec.algorithm.width(),
                });
            }
            if rests {
                entry.calibration.queue = Default::default();
                entry.calibration.witness.second = Default::default();
                // A replay in progress has read results that are dropped now.
                entry.rewinds += 1;
                self.rewinds.push(id);
            }
        }
        // This fact comes last. A crash that loses it leaves a worker that can be convicted again.
        self.facts.push(Fact::Quarantined {
            worker: worker.to_owned(),
            calibration,
            evaluation,
        });
    }

    /// Finishes a calibration with only comparisons left, once they are made or no worker can make them.
    pub(super) fn finish_if_compared(&mut self, id: i64, now_ms: u64) {
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return;
        };
        if entry.rewinds > 0 || !entry.calibration.is_concluded() || !entry.calibration.is_open() {
            return;
        }
        let calibration = &mut entry.calibration;
        let version = calibration.model_version.as_deref().map(equations_of);
        let external = calibration.spec.model.external.as_ref().map(|m| m.source.name());
        let (workers, quarantine, patience_ms) = (&self.workers, &self.quarantine, self.lease_ms);
        let can_answer = |answers: &[Answer]| {
            workers.iter().any(|(name, worker)| {
                let is_able = version == worker.equations_of_model(external.as_deref()).map(equations_of);
                let is_there = now_ms.saturating_sub(worker.last_seen_ms) < patience_ms;
                let has_answered = answers.iter().any(|answer| answer.worker == *name);
                is_able && is_there && !has_answered && !quarantine.contains_key(name)
            })
        };
        let mean_ms = entry.pace.mean_lease_ms().unwrap_or_default();
        let hung_ms = HUNG_TIMES * mean_ms + self.lease_ms;
        self.counters.unanswered += calibration
            .witness
            .second
            .drop_hopeless(can_answer, hung_ms, now_ms);
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
            let Some(mean_ms) = pace.mean_lease_ms() else {
                continue;
            };
            let slow: Vec<(u64, SlowLease)> = calibration
                .queue
                .older_than(SLOW_TIMES * mean_ms + SLOW_MS, now_ms)
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

fn reason(worker: &str, calibration: i64, evaluation: u64) -> String {
    format!(
        "worker {worker} computes wrongly and is quarantined: its answer to evaluation {evaluation} of calibration {calibration} is contradicted; find out why, then start it anew"
    )
}
