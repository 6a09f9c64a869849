//! The effect of a worker's result on the farm.

use std::borrow::Cow;

use shared::api::CalibrationState;
use shared::exchange::WorkResult;
use shared::model::equations_of;

use super::farm::{Ended, Farm};
use super::replay_cause::ReplayCause;
use super::seal::{LeaseTerms, proves};
use super::worker_record::WorkerRecord;
use crate::calibration::{Calibration, ResultError, SimulationResult};
use crate::lease::LeaseFailure;
use record::fact::Fact;

/// The number of a worker's first results that are all compared with those of another worker.
const NEW_WORKER_RESULTS: u64 = 5;

/// The effect of a result.
enum Taken {
    /// The result counts, or its lease has failed.
    New,
    /// The result changes nothing.
    Duplicate,
    /// The result does not answer a lease of its worker.
    Refused,
}

impl Farm {
    /// Takes the results of a worker. Returns the number of those that changed nothing.
    pub(super) fn take_results(&mut self, worker: &str, results: Vec<WorkResult>, now_ms: u64) -> u32 {
        let (mut duplicates, mut refused_leases) = (0, Vec::new());
        for result in results {
            let lease = result.lease;
            // An earlier result of the same message may have convicted the worker.
            if self.quarantined(worker).is_some() {
                refused_leases.push(lease);
                continue;
            }
            match self.take_result(worker, result, now_ms) {
                Taken::New => {}
                Taken::Duplicate => duplicates += 1,
                Taken::Refused => refused_leases.push(lease),
            }
        }
        if let Some(lease) = refused_leases.first() {
            let results = refused_leases.len();
            tracing::warn!(
                worker,
                lease,
                results,
                quarantined = self.quarantined(worker).is_some(),
                "results refused: their seals do not prove that they answer leases of this worker, or it computes wrongly; the first lease is named"
            );
            self.counters.refused += results as u64;
        }
        self.counters.duplicates += u64::from(duplicates);
        duplicates + refused_leases.len() as u32
    }

    /// Takes a result from a worker that has stated its version of the equations. The first result that counts pins the calibration to this
    /// version.
    fn take_result(&mut self, worker: &str, result: WorkResult, now_ms: u64) -> Taken {
        let (id, lease, repeated) = (result.calibration, result.lease, result.repeated);
        if let Some(closed) = self.closed(id) {
            return self.compare_late(worker, result, &closed);
        }
        let version = match self.proven_version(worker, &result) {
            Ok(version) => version,
            Err(taken) => return taken,
        };
        let taken = match self.complete(worker, result, now_ms) {
            Ok((facts, true)) => {
                self.pin(id, version);
                self.keep(facts);
                let repeated = repeated.map(|repeated| Fact::Repeated {
                    calibration: id,
                    repeated,
                });
                self.facts.extend(repeated);
                self.credit(worker);
                Taken::New
            }
            Ok((facts, false)) => {
                self.keep(facts);
                Taken::Duplicate
            }
            Err(error) => {
                self.fail(id, lease, worker, &error.to_string());
                Taken::New
            }
        };
        self.settle(id, now_ms);
        self.finish_if_compared(id, now_ms);
        taken
    }

    /// Returns the model version under which the seal of a result matches a lease of its worker.
    fn proven_version(&self, worker: &str, result: &WorkResult) -> Result<String, Taken> {
        let Some(entry) = self.calibrations.get(&result.calibration) else {
            return Err(Taken::Duplicate);
        };
        let (calibration, evaluation) = (&entry.calibration, result.evaluation);
        let record = self.workers.get(worker);
        let Some(version) = record.and_then(|record| record.equations_for(calibration)) else {
            // The worker ran the model when it took the lease, but its present version is unknown.
            return Err(Taken::Refused);
        };
        let pinned = calibration.model_version.as_deref();
        let is_other = pinned.is_some_and(|pinned| equations_of(pinned) != equations_of(version));
        if is_other && calibration.spec.model.external.is_some() {
            // The model has changed since the lease.
            return Err(Taken::Refused);
        }
        let model_version = model_version(calibration, version);
        let terms = LeaseTerms {
            lease: result.lease,
            worker,
            calibration: result.calibration,
            evaluation,
            model_version: &model_version,
        };
        let question = calibration.question(evaluation);
        let question = question.or_else(|| calibration.witness.second.question(evaluation));
        match proves(&result.seal, entry.key, terms, question) {
            true => Ok(model_version.into_owned()),
            false => Err(Taken::Refused),
        }
    }

    /// Completes the evaluation of a result with a valid seal. Returns the facts to store, and whether the result counted.
    fn complete(
        &mut self,
        worker: &str,
        result: WorkResult,
        now_ms: u64,
    ) -> Result<(Vec<Fact>, bool), ResultError> {
        let Some(entry) = self.calibrations.get_mut(&result.calibration) else {
            return Ok((Vec::new(), false));
        };
        let calibration = &mut entry.calibration;
        if let Some(age_ms) = calibration.queue.age_ms(result.lease, worker, now_ms) {
            entry.pace.count_lease(age_ms);
        }
        let computed = SimulationResult::new(result.outcome)?;
        let record = self.workers.get(worker);
        let is_new = record.is_none_or(|record| record.completed < NEW_WORKER_RESULTS);
        let completed = match is_new {
            true => calibration.complete_verified(result.evaluation, computed, worker)?,
            false => calibration.complete(result.evaluation, computed, worker)?,
        };
        entry.pace.count(calibration.cost.simulations, now_ms);
        Ok(completed)
    }

    /// Pins a calibration to a version of the model, unless it is pinned. Leases of workers of other versions are taken back.
    fn pin(&mut self, id: i64, version: String) {
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return;
        };
        let calibration = &mut entry.calibration;
        if calibration.model_version.is_some() {
            return;
        }
        let is_other = |worker: &WorkerRecord| {
            let stated = worker.equations_for(calibration);
            stated.is_none_or(|stated| equations_of(stated) != equations_of(&version))
        };
        let workers = self.workers.iter().filter(|(_, worker)| is_other(worker));
        let other_workers: Vec<&String> = workers.map(|(name, _)| name).collect();
        let queue = &mut calibration.queue;
        queue.take_back_of(|name| other_workers.iter().any(|other| *other == name));
        calibration.model_version = Some(version.clone());
        let calibration = id;
        self.facts.push(Fact::ModelVersion { calibration, version });
    }

    /// Pins a calibration to the version that its operator has chosen, and lets it run. Results of another version are dropped, and the
    /// calibration is replayed from what remains: nothing.
    pub(super) fn repin(&mut self, id: i64, version: String) {
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return;
        };
        entry.calibration.model_version = Some(version.clone());
        let calibration = id;
        self.facts.push(Fact::Repinned { calibration, version });
        entry.await_replay(ReplayCause::Version);
        self.rewinds.push(id);
        if entry.calibration.state == CalibrationState::Paused {
            entry
                .calibration
                .change_state(CalibrationState::Running, None, &mut self.facts);
        }
    }

    /// Hands the facts of a result to the store.
    pub(super) fn keep(&mut self, facts: Vec<Fact>) {
        let is_confirmation = |fact: &&Fact| matches!(fact, Fact::Confirmed { .. });
        self.counters.confirmed += facts.iter().filter(is_confirmation).count() as u64;
        self.facts.extend(facts);
    }

    /// Counts a result of a worker.
    fn credit(&mut self, worker: &str) {
        let record = self.worker_mut(worker);
        record.completed += 1;
        let is_in_queue = record.queue_job.is_some();
        self.counters.completed += 1;
        self.counters.completed_in_queues += u64::from(is_in_queue);
    }

    /// Fails a lease whose worker returned no valid result.
    fn fail(&mut self, id: i64, lease: u64, worker: &str, message: &str) {
        self.worker_mut(worker).faults += 1;
        self.counters.failed_leases += 1;
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return;
        };
        let calibration = &mut entry.calibration;
        if let Some(failure) = calibration.queue.fail(lease) {
            calibration.drop_idle_seconds();
            self.facts.extend(calibration.lease_failed(&failure, message));
            return;
        }
        let second = &mut calibration.witness.second;
        if let Some(failure) = second.queue.fail(lease).filter(LeaseFailure::exhausted) {
            second.drop(failure.evaluation);
        }
    }

    fn worker_mut(&mut self, worker: &str) -> &mut WorkerRecord {
        self.workers
            .get_mut(worker)
            .expect("the worker of an exchange is on record")
    }

    /// Returns the key and the model version of a calibration that takes no results, because it has ended or waits for its replay. After a
    /// replay, a result counts if its evaluation is asked for again.
    fn closed(&self, id: i64) -> Option<Ended> {
        let Some(entry) = self.calibrations.get(&id) else {
            return self.ended.get(&id).cloned();
        };
        let calibration = &entry.calibration;
        let is_closed = entry.rewinds > 0 || calibration.state.is_final();
        is_closed.then(|| Ended {
            key: entry.key,
            model_version: calibration.model_version.clone().unwrap_or_default(),
            is_rewound: entry.rewinds > 0 || calibration.witness.is_rewound,
        })
    }

    /// Sends a result that does not count to the store for comparison.
    fn compare_late(&mut self, worker: &str, result: WorkResult, closed: &Ended) -> Taken {
        let (calibration, evaluation) = (result.calibration, result.evaluation);
        let terms = LeaseTerms {
            lease: result.lease,
            worker,
            calibration,
            evaluation,
            model_version: &closed.model_version,
        };
        if !proves(&result.seal, closed.key, terms, None) {
            return Taken::Refused;
        }
        // After a rewind, the number may stand for another question.
        let computed = SimulationResult::new(result.outcome);
        if let Some(computed) = computed.ok().filter(|_| !closed.is_rewound) {
            self.facts.push(Fact::Duplicate {
                calibration,
                evaluation,
                fingerprint: computed.fingerprint(),
                worker: worker.to_owned(),
            });
        }
        Taken::Duplicate
    }
}

/// Returns the version that a calibration is pinned to; before its first result, the version that a result of this worker would pin it to.
pub(super) fn model_version<'a>(calibration: &'a Calibration, version: &str) -> Cow<'a, str> {
    match &calibration.model_version {
        Some(pinned) => Cow::Borrowed(pinned),
        None => Cow::Owned(calibration.spec.fit_variant.model_version(equations_of(version))),
    }
}
