//! The farm: all calibrations in progress and all known workers; which worker evaluates what.

use std::borrow::Cow;
use std::collections::BTreeMap;

use shared::api::{CalibrationState, CalibrationStatus};
use shared::exchange::{ExchangeRequest, ExchangeResponse, Lease, WorkResult};
use shared::model::{ModelVariant, equations_of};

use super::control::{Control, ControlError};
use super::lease_numbers::LeaseNumbers;
use super::metrics::{FarmCounters, FarmMetrics};
use super::progress::{self, Pace};
use super::seal::{LeaseTerms, proves, seal};
use super::share::deal;
use super::worker_record::WorkerRecord;
use crate::calibration::{Calibration, SimulationResult};
use record::SealKey;
use record::fact::Fact;

/// A worker is counted as connected for so long after its last message `[ms]`.
const WORKER_SILENCE_MS: u64 = 60_000;

/// All calibrations in progress and all known workers.
#[derive(Debug)]
pub struct Farm {
    calibrations: BTreeMap<i64, Entry>,
    /// Calibrations that ended since the start: their late results are compared.
    ended: BTreeMap<i64, Ended>,
    workers: BTreeMap<String, WorkerRecord>,
    counters: FarmCounters,
    facts: Vec<Fact>,
    lease_numbers: LeaseNumbers,
    lease_ms: u64,
}

#[derive(Debug)]
struct Entry {
    calibration: Calibration,
    key: SealKey,
    pace: Pace,
    /// When busy time was last added up `[ms]`.
    counted_ms: u64,
}

/// What the late results of a calibration that ended are checked by.
#[derive(Debug)]
struct Ended {
    key: SealKey,
    model_version: String,
}

/// What becomes of a result.
enum Taken {
    /// It counts, or its machine failed.
    New,
    /// It changes nothing.
    Duplicate,
    /// It does not answer what was asked of its worker.
    Refused,
}

impl Farm {
    /// An empty farm; `epoch` numbers the starts of the coordinator, so lease numbers never repeat.
    pub fn new(epoch: u64, lease_ms: u64) -> Self {
        Farm {
            calibrations: BTreeMap::new(),
            ended: BTreeMap::new(),
            workers: BTreeMap::new(),
            counters: FarmCounters::default(),
            facts: Vec::new(),
            lease_numbers: LeaseNumbers::new(epoch),
            lease_ms,
        }
    }

    /// Adds a calibration, with facts of its replay that may have been lost.
    pub fn add(&mut self, calibration: Calibration, key: SealKey, facts: Vec<Fact>, now_ms: u64) {
        self.facts.extend(facts);
        let pace = Pace::new(calibration.evaluations, now_ms);
        let entry = Entry {
            calibration,
            key,
            pace,
            counted_ms: now_ms,
        };
        self.calibrations.insert(entry.calibration.identity.id, entry);
        // A replay may have ended it: then its late results are compared from now on.
        self.account(now_ms);
    }

    /// The facts since the last call, in order.
    pub fn take_facts(&mut self) -> Vec<Fact> {
        std::mem::take(&mut self.facts)
    }

    /// Numbers for the metrics page.
    pub fn metrics(&self) -> FarmMetrics {
        let leased = |e: &Entry| e.calibration.queue.leased();
        FarmMetrics {
            counters: self.counters.clone(),
            queued: self.remaining(),
            leased: self.calibrations.values().map(leased).sum(),
            calibrations: self.calibrations.len(),
            workers: self.workers.len(),
        }
    }

    /// Whether an exchange would give a lease to somebody.
    pub fn has_work(&self) -> bool {
        self.remaining() > 0
    }

    fn remaining(&self) -> u64 {
        let open = self.calibrations.values().filter(|e| e.calibration.is_open());
        open.map(|e| e.calibration.queue.unleased() as u64).sum()
    }

    /// Takes a worker's results, renewals and returns, and leases it what it wants.
    pub fn exchange(&mut self, request: ExchangeRequest, now_ms: u64) -> ExchangeResponse {
        let worker = request.worker;
        let record = self
            .workers
            .entry(worker.clone())
            .or_insert_with(|| WorkerRecord {
                model_version: request.model_version.clone(),
                holds: 0,
                completed: 0,
                faults: 0,
                silent_ms: 0,
                last_seen_ms: now_ms,
                given: 0,
            });
        record.last_seen_ms = now_ms;
        // The last message tells: what waits for a worker of its version must not wait for one that has become another.
        record.model_version.clone_from(&request.model_version);
        // An answer to this worker was lost: it speaks again without having received its last leases.
        let lost = request.received < record.given;
        record.given = record.given.min(request.received);
        let (mut duplicates, mut refused_leases) = (0, Vec::new());
        for result in request.results {
            let lease = result.lease;
            match self.take_result(&worker, &request.model_version, result, now_ms) {
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
                "results refused: their seals do not prove that they answer leases of this worker; the first lease is named"
            );
            self.counters.refused += results as u64;
        }
        self.counters.duplicates += u64::from(duplicates);
        for lease in request.holding {
            let until = now_ms + self.lease_ms;
            self.calibrations
                .values_mut()
                .any(|e| e.calibration.queue.renew(lease, &worker, until));
        }
        for lease in request.started {
            let until = now_ms + self.lease_ms;
            self.calibrations
                .values_mut()
                .any(|e| e.calibration.queue.start(lease, &worker, until));
        }
        if lost {
            let queues = self.calibrations.values_mut().map(|e| &mut e.calibration.queue);
            self.counters.lost += queues
                .map(|q| q.take_back_above(request.received, &worker))
                .sum::<u64>();
        }
        for lease in request.returned {
            self.give_back(lease, &worker);
        }
        self.account(now_ms);
        let (leases, refused) = self.lease(&worker, &request.model_version, request.want as usize, now_ms);
        ExchangeResponse {
            leases,
            lease_ms: self.lease_ms,
            remaining: self.remaining(),
            workers: self.workers.len() as u32,
            duplicates: duplicates + refused_leases.len() as u32,
            refused,
        }
    }

    /// Takes a result from a worker that computes a version of the equations. The first that counts pins its calibration to it.
    fn take_result(&mut self, worker: &str, version: &str, result: WorkResult, now_ms: u64) -> Taken {
        let (id, lease, evaluation) = (result.calibration, result.lease, result.evaluation);
        let terms = |model_version| LeaseTerms {
            lease,
            worker,
            calibration: id,
            evaluation,
            model_version,
        };
        let Some(entry) = self.calibrations.get_mut(&id) else {
            let Some(ended) = self.ended.get(&id) else {
                return Taken::Duplicate;
            };
            if !proves(&result.seal, ended.key, terms(&ended.model_version), None) {
                return Taken::Refused;
            }
            if let Ok(computed) = SimulationResult::of(result) {
                self.facts.push(Fact::Duplicate {
                    calibration: id,
                    evaluation,
                    fingerprint: computed.fingerprint(),
                    worker: worker.to_owned(),
                });
            }
            return Taken::Duplicate;
        };
        let calibration = &mut entry.calibration;
        let model_version = model_version(calibration, version);
        let question = calibration.question(evaluation);
        if !proves(&result.seal, entry.key, terms(&model_version), question) {
            return Taken::Refused;
        }
        let pin = calibration
            .model_version
            .is_none()
            .then(|| model_version.into_owned());
        let taken = match SimulationResult::of(result) {
            Ok(computed) => match calibration.complete(evaluation, computed, worker) {
                Ok((facts, counted)) => {
                    if let Some(version) = pin.filter(|_| counted) {
                        let is_other = |name: &str| {
                            let other = self.workers.get(name);
                            other.is_none_or(|o| equations_of(&o.model_version) != equations_of(&version))
                        };
                        calibration.queue.take_back_of(is_other);
                        calibration.model_version = Some(version.clone());
                        let calibration = id;
                        self.facts.push(Fact::ModelVersion { calibration, version });
                    }
                    self.facts.extend(facts);
                    entry.pace.count(calibration.evaluations, now_ms);
                    Ok(counted)
                }
                Err(error) => Err(error.to_string()),
            },
            Err(fault) => Err(fault),
        };
        let record = self
            .workers
            .get_mut(worker)
            .expect("the worker of an exchange is on record");
        match taken {
            Ok(true) => {
                record.completed += 1;
                self.counters.completed += 1;
                Taken::New
            }
            Ok(false) => Taken::Duplicate,
            Err(message) => {
                record.faults += 1;
                self.counters.failed_leases += 1;
                if let Some(failure) = calibration.queue.fail(lease) {
                    self.facts.extend(calibration.lease_failed(&failure, &message));
                }
                Taken::New
            }
        }
    }

    pub(super) fn give_back(&mut self, lease: u64, worker: &str) {
        self.calibrations
            .values_mut()
            .any(|e| e.calibration.queue.give_back(lease, worker));
    }

    fn held_by(&self, worker: &str) -> usize {
        self.calibrations
            .values()
            .map(|e| e.calibration.queue.held_by(worker))
            .sum()
    }

    /// The calibrations that may lease to a worker that holds so many leases, in turn, with the most that each may give: first
    /// those with suspects where its hands are empty, then the oldest; first its share of each, then what is left.
    fn turns(&self, want: usize, holds: usize) -> Vec<(i64, usize)> {
        let waits = |e: &&Entry| e.calibration.is_open() && e.calibration.queue.unleased() > 0;
        let waiting: Vec<&Calibration> = self
            .calibrations
            .values()
            .filter(waits)
            .map(|e| &e.calibration)
            .collect();
        let queues: Vec<(usize, usize)> = waiting
            .iter()
            .map(|c| (c.queue.leased(), c.queue.unleased()))
            .collect();
        let ids = waiting.iter().map(|c| c.identity.id);
        let mut turns: Vec<(i64, usize)> = ids.clone().zip(deal(&queues, want)).collect();
        if holds == 0 {
            let suspected = |id: &i64| self.calibrations[id].calibration.queue.suspects() > 0;
            turns.sort_by_key(|(id, _)| !suspected(id));
            // A suspect goes to empty hands, however many leases of its calibration are out.
            if let Some((_, most)) = turns.first_mut().filter(|(id, _)| suspected(id)) {
                *most = (*most).max(1);
            }
        }
        turns.extend(ids.map(|id| (id, want)));
        turns
    }

    /// Leases up to `want` evaluations.
    fn lease(
        &mut self,
        worker: &str,
        version: &str,
        want: usize,
        now_ms: u64,
    ) -> (Vec<Lease>, Option<String>) {
        let mut leases = Vec::new();
        let mut refused = None;
        let expires_ms = now_ms + self.lease_ms;
        let mut holds = self.held_by(worker);
        let holds_suspect = |e: &Entry| e.calibration.queue.holds_suspect(worker);
        if want == 0 || (holds > 0 && self.calibrations.values().any(holds_suspect)) {
            return (leases, refused);
        }
        for (id, most) in self.turns(want, holds) {
            let Some(entry) = self.calibrations.get_mut(&id) else {
                continue;
            };
            let calibration = &mut entry.calibration;
            // The files of effects travel with the variant: a worker need not know them.
            let pinned = calibration.model_version.as_deref().map(equations_of);
            if let Some(pinned) = pinned.filter(|pinned| *pinned != equations_of(version)) {
                refused = Some(format!(
                    "calibration {id} was begun with model version {pinned}, worker {worker} computes {version}"
                ));
                continue;
            }
            let lease_numbers = &mut self.lease_numbers;
            let next_lease = || lease_numbers.next_number();
            let workers = &self.workers;
            let has_other = |failed: &[String]| {
                workers.iter().any(|(name, other)| {
                    let is_able = equations_of(&other.model_version) == equations_of(version);
                    is_able && !failed.contains(name)
                })
            };
            let wanted = most.min(want - leases.len());
            let claims = calibration
                .queue
                .claim(worker, wanted, holds, expires_ms, has_other, next_lease);
            holds += claims.len();
            self.counters.leased += claims.len() as u64;
            if !claims.is_empty() && calibration.state == CalibrationState::Queued {
                calibration.change_state(CalibrationState::Running, None, &mut self.facts);
            }
            let is_alone = claims.iter().any(|claim| claim.suspect);
            for claim in claims {
                let (lease, evaluation) = (claim.lease, claim.evaluation);
                let question = calibration
                    .question(evaluation)
                    .expect("a claimed evaluation is asked for at present");
                let terms = LeaseTerms {
                    lease,
                    worker,
                    calibration: id,
                    evaluation,
                    model_version: &model_version(calibration, version),
                };
                leases.push(Lease {
                    lease,
                    calibration: id,
                    evaluation,
                    seal: seal(entry.key, terms, question),
                    variant: question.variant.to_owned(),
                    theta: question.theta.to_vec(),
                    announce: claim.suspect,
                    subchain: question.subchain,
                });
            }
            if is_alone {
                break;
            }
        }
        if let (Some(record), Some(last)) = (self.workers.get_mut(worker), leases.last()) {
            record.given = last.lease;
        }
        (leases, refused)
    }

    /// Advances the clock: expires leases, removes silent workers, adds up busy time.
    pub fn tick(&mut self, now_ms: u64) {
        for entry in self.calibrations.values_mut() {
            let expired = entry.calibration.queue.expire(now_ms);
            self.counters.failed_leases += expired.unstarted;
            for failure in expired.failures {
                self.counters.failed_leases += 1;
                if let Some(record) = self.workers.get_mut(&failure.worker) {
                    record.faults += 1;
                }
                let message = format!("the lease expired after {} ms without renewal", self.lease_ms);
                self.facts
                    .extend(entry.calibration.lease_failed(&failure, &message));
            }
            for evaluation in expired.never_begun {
                self.facts.extend(entry.calibration.never_begun(evaluation));
            }
        }
        self.workers
            .retain(|_, w| now_ms.saturating_sub(w.last_seen_ms) < WORKER_SILENCE_MS);
        self.account(now_ms);
    }

    /// Adds up busy time and removes calibrations that are over.
    fn account(&mut self, now_ms: u64) {
        for entry in self.calibrations.values_mut() {
            // What waits for others has not begun to cost anything.
            let calibration = &entry.calibration;
            if calibration.state == CalibrationState::Running && calibration.queue.leased() > 0 {
                entry.calibration.busy_ms += now_ms.saturating_sub(entry.counted_ms);
            }
            entry.counted_ms = now_ms;
        }
        let ended = self
            .calibrations
            .extract_if(.., |_, e| e.calibration.state.is_final());
        self.ended.extend(ended.map(|(id, entry)| {
            let model_version = entry.calibration.model_version.unwrap_or_default();
            let key = entry.key;
            (id, Ended { key, model_version })
        }));
    }

    /// Executes a user's command.
    ///
    /// # Errors
    /// [`ControlError`] where the calibration is over or the command does not fit.
    pub fn control(
        &mut self,
        id: i64,
        control: Control,
        now_ms: u64,
    ) -> Result<CalibrationState, ControlError> {
        let entry = self
            .calibrations
            .get_mut(&id)
            .ok_or(ControlError::NotInProgress(id))?;
        let calibration = &mut entry.calibration;
        let state = calibration.state;
        match (control, state) {
            (Control::Cancel, _) => {
                calibration.change_state(CalibrationState::Cancelled, None, &mut self.facts)
            }
            (Control::Pause, CalibrationState::Queued | CalibrationState::Running) => {
                let message = Some("paused by a user".to_owned());
                calibration.change_state(CalibrationState::Paused, message, &mut self.facts);
            }
            (Control::Resume { skip_faults }, CalibrationState::Paused) => {
                calibration.resume(skip_faults, &mut self.facts);
            }
            (Control::Pause, _) => {
                return Err(ControlError::WrongState {
                    id,
                    state,
                    verb: "paused",
                });
            }
            (Control::Resume { .. }, _) => {
                return Err(ControlError::WrongState {
                    id,
                    state,
                    verb: "resumed",
                });
            }
        }
        let state = calibration.state;
        self.account(now_ms);
        Ok(state)
    }

    /// The status of a calibration in progress.
    pub fn status(&self, id: i64, now_ms: u64) -> Option<CalibrationStatus> {
        self.calibrations
            .get(&id)
            .map(|e| progress::status(&e.calibration, &e.pace, now_ms))
    }

    /// Ids of the calibrations in progress.
    pub fn ids(&self) -> Vec<i64> {
        self.calibrations.keys().copied().collect()
    }

    /// The known workers.
    pub fn workers(&self, now_ms: u64) -> BTreeMap<String, WorkerRecord> {
        let mut workers = self.workers.clone();
        for (name, record) in &mut workers {
            record.holds = self.held_by(name) as u64;
            record.silent_ms = now_ms.saturating_sub(record.last_seen_ms);
        }
        workers
    }

    /// The variant of a hash, if a calibration in hand uses it.
    pub fn variant(&self, hash: &str) -> Option<ModelVariant> {
        self.calibrations
            .values()
            .find_map(|e| e.calibration.variant(hash))
            .cloned()
    }
}

/// The version that a calibration is pinned to; before its first result, what it would be pinned to by a worker's.
fn model_version<'a>(calibration: &'a Calibration, version: &str) -> Cow<'a, str> {
    match &calibration.model_version {
        Some(pinned) => Cow::Borrowed(pinned),
        None => Cow::Owned(calibration.spec.fit_variant.model_version(equations_of(version))),
    }
}
