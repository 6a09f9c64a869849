//! The farm: all calibrations in progress and all known workers; which worker evaluates what.

use std::borrow::Cow;
use std::collections::BTreeMap;

use shared::api::{CalibrationState, CalibrationStatus};
use shared::exchange::{ExchangeRequest, ExchangeResponse, WorkResult};
use shared::model::{ModelVariant, equations_of};

use super::control::{Control, ControlError};
use super::lease_numbers::LeaseNumbers;
use super::metrics::{FarmCounters, FarmMetrics};
use super::progress::{self, Pace};
use super::seal::{LeaseTerms, proves};
use super::worker_record::WorkerRecord;
use crate::calibration::{Calibration, SimulationResult};
use crate::lease::{LeaseFailure, LeaseQueue};
use record::SealKey;
use record::fact::Fact;

/// A worker is counted as connected for so long after its last message `[ms]`.
const WORKER_SILENCE_MS: u64 = 60_000;

/// So many results of a worker that nobody has heard of before are all compared with those of another.
const NEW_WORKER_RESULTS: u64 = 5;

/// All calibrations in progress and all known workers.
#[derive(Debug)]
pub struct Farm {
    pub(super) calibrations: BTreeMap<i64, Entry>,
    /// Calibrations that ended since the start: their late results are compared.
    ended: BTreeMap<i64, Ended>,
    pub(super) workers: BTreeMap<String, WorkerRecord>,
    /// Workers that compute wrongly, with the reason.
    pub(super) quarantine: BTreeMap<String, String>,
    /// Calibrations to replay without the results of such workers, since they were last asked for.
    pub(super) rewinds: Vec<i64>,
    pub(super) counters: FarmCounters,
    pub(super) facts: Vec<Fact>,
    pub(super) lease_numbers: LeaseNumbers,
    pub(super) lease_ms: u64,
}

#[derive(Debug)]
pub(super) struct Entry {
    pub(super) calibration: Calibration,
    pub(super) key: SealKey,
    pub(super) pace: Pace,
    /// How many replays it waits for; it neither leases nor takes anything until the last.
    pub(super) rewinds: u32,
    /// Whether the last of them failed, so that it has to be asked for again.
    pub(super) is_replay_due: bool,
    /// When busy time was last added up `[ms]`.
    counted_ms: u64,
}

impl Entry {
    fn queues(&mut self) -> [&mut LeaseQueue; 2] {
        let Calibration { queue, second, .. } = &mut self.calibration;
        [queue, &mut second.queue]
    }
}

/// What the late results of a calibration that takes none are checked by.
#[derive(Debug, Clone)]
struct Ended {
    key: SealKey,
    model_version: String,
    is_rewound: bool,
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
            quarantine: BTreeMap::new(),
            rewinds: Vec::new(),
            counters: FarmCounters::default(),
            facts: Vec::new(),
            lease_numbers: LeaseNumbers::new(epoch),
            lease_ms,
        }
    }

    /// Adds a calibration, with facts of its replay that may have been lost. One that was replayed because of a worker that computes
    /// wrongly takes the place of itself.
    pub fn add(&mut self, mut calibration: Calibration, key: SealKey, facts: Vec<Fact>, now_ms: u64) {
        let id = calibration.identity.id;
        if self.ended.contains_key(&id) {
            // Cancelled while it was replayed.
            return;
        }
        if let Some(before) = self.calibrations.get_mut(&id) {
            before.rewinds = before.rewinds.saturating_sub(1);
            if before.rewinds > 0 {
                // It was read before more of it was dropped.
                return;
            }
            // What a user has said meanwhile holds.
            if !calibration.state.is_final() {
                calibration.state = before.calibration.state;
                calibration.message.clone_from(&before.calibration.message);
            }
            calibration.busy_ms = before.calibration.busy_ms;
        }
        self.facts.extend(facts);
        let pace = Pace::new(calibration.simulations, now_ms);
        let entry = Entry {
            calibration,
            key,
            pace,
            rewinds: 0,
            is_replay_due: false,
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
        let leased = |e: &Entry| e.calibration.queue.leased() + e.calibration.second.queue.leased();
        let waiting = |e: &Entry| e.calibration.second.waiting();
        FarmMetrics {
            counters: self.counters.clone(),
            queued: self.remaining(),
            leased: self.calibrations.values().map(leased).sum(),
            calibrations: self.calibrations.len(),
            workers: self.workers.len(),
            unconfirmed: self.calibrations.values().map(waiting).sum(),
            quarantined: self.quarantine.len(),
        }
    }

    /// Whether an exchange would give a lease to somebody.
    pub fn has_work(&self) -> bool {
        let second = |e: &Entry| e.calibration.is_open() && e.calibration.second.queue.unleased() > 0;
        self.remaining() > 0 || self.calibrations.values().any(second)
    }

    /// Workers that are not quarantined. Counted over the few that are: every exchange asks, and there may be many workers.
    pub(super) fn able_workers(&self) -> usize {
        let is_known = |name: &&String| self.workers.contains_key(*name);
        self.workers.len() - self.quarantine.keys().filter(is_known).count()
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
                models: request.models.clone(),
                queue_job: request.queue_job.clone(),
                threads: request.threads,
                evaluation_s: request.evaluation_s,
                holds: 0,
                completed: 0,
                faults: 0,
                silent_ms: 0,
                last_seen_ms: now_ms,
                given: 0,
                quarantined: None,
            });
        record.last_seen_ms = now_ms;
        // The last message tells: what waits for a worker of its version must not wait for one that has become another.
        record.model_version.clone_from(&request.model_version);
        record.models.clone_from(&request.models);
        record.evaluation_s = request.evaluation_s;
        // An answer to this worker was lost: it speaks again without having received its last leases.
        let lost = request.received < record.given;
        record.given = record.given.min(request.received);
        let (mut duplicates, mut refused_leases) = (0, Vec::new());
        let quarantine = self.quarantine.get(&worker).cloned();
        for result in request.results {
            let lease = result.lease;
            if quarantine.is_some() {
                refused_leases.push(lease);
                continue;
            }
            match self.take_result(&worker, result, now_ms) {
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
                quarantined = quarantine.is_some(),
                "results refused: their seals do not prove that they answer leases of this worker, or it computes wrongly; the first lease is named"
            );
            self.counters.refused += results as u64;
        }
        self.counters.duplicates += u64::from(duplicates);
        for lease in request.holding {
            let until = now_ms + self.lease_ms;
            self.queues().any(|queue| queue.renew(lease, &worker, until));
        }
        for lease in request.started {
            let until = now_ms + self.lease_ms;
            self.queues().any(|queue| queue.start(lease, &worker, until));
        }
        if lost {
            let take_back = |q: &mut LeaseQueue| q.take_back_above(request.received, &worker);
            self.counters.lost += self.queues().map(take_back).sum::<u64>();
        }
        for lease in request.returned {
            self.give_back(lease, &worker);
        }
        for entry in self.calibrations.values_mut() {
            entry.calibration.drop_idle_seconds();
        }
        self.account(now_ms);
        // It may have been quarantined for what it has just said.
        let (leases, refused) = match self.quarantine.get(&worker) {
            Some(reason) => (Vec::new(), Some(reason.clone())),
            None => self.lease(&worker, request.want as usize, now_ms),
        };
        ExchangeResponse {
            leases,
            lease_ms: self.lease_ms,
            remaining: self.remaining(),
            in_hand: self
                .calibrations
                .values()
                .filter(|e| e.calibration.is_open())
                .count() as u64,
            workers: self.able_workers() as u32,
            duplicates: duplicates + refused_leases.len() as u32,
            refused,
        }
    }

    /// Takes a result from a worker that has said which version of the equations it computes. The first that counts pins its
    /// calibration to it.
    fn take_result(&mut self, worker: &str, result: WorkResult, now_ms: u64) -> Taken {
        let (id, lease, evaluation) = (result.calibration, result.lease, result.evaluation);
        if let Some(closed) = self.closed(id) {
            return self.compare_late(worker, result, &closed);
        }
        let terms = |model_version| LeaseTerms {
            lease,
            worker,
            calibration: id,
            evaluation,
            model_version,
        };
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return Taken::Duplicate;
        };
        let calibration = &mut entry.calibration;
        let record = self.workers.get(worker);
        let Some(version) = record.and_then(|own| own.equations_for(calibration)) else {
            // It ran the model when it took the lease; what it runs now is not known.
            return Taken::Refused;
        };
        let pinned = calibration.model_version.as_deref();
        let is_other = pinned.is_some_and(|pinned| equations_of(pinned) != equations_of(version));
        if is_other && calibration.spec.model.external.is_some() {
            // The model has become another one since the lease.
            return Taken::Refused;
        }
        let model_version = model_version(calibration, version);
        let question = calibration.question(evaluation);
        let question = question.or_else(|| calibration.second.question(evaluation));
        if !proves(&result.seal, entry.key, terms(&model_version), question) {
            return Taken::Refused;
        }
        let pin = calibration
            .model_version
            .is_none()
            .then(|| model_version.into_owned());
        let is_new = self
            .workers
            .get(worker)
            .is_none_or(|w| w.completed < NEW_WORKER_RESULTS);
        if let Some(age_ms) = calibration.queue.age_ms(lease, worker, now_ms) {
            entry.pace.count_lease(age_ms);
        }
        let repeated = result.repeated;
        let completed = SimulationResult::of(result).and_then(|computed| {
            if is_new {
                calibration.verify(evaluation);
            }
            let completed = calibration.complete(evaluation, computed, worker);
            completed.map_err(|error| error.to_string())
        });
        let taken = completed.map(|(facts, counted)| {
            if let Some(version) = pin.filter(|_| counted) {
                let is_other = |name: &str| {
                    let other = self.workers.get(name);
                    let theirs = other.and_then(|other| other.equations_for(calibration));
                    theirs.is_none_or(|theirs| equations_of(theirs) != equations_of(&version))
                };
                let others: Vec<&String> = self.workers.keys().filter(|name| is_other(name)).collect();
                calibration
                    .queue
                    .take_back_of(|name| others.iter().any(|other| *other == name));
                calibration.model_version = Some(version.clone());
                let calibration = id;
                self.facts.push(Fact::ModelVersion { calibration, version });
            }
            let is_confirmation = |fact: &&Fact| matches!(fact, Fact::Confirmed { .. });
            self.counters.confirmed += facts.iter().filter(is_confirmation).count() as u64;
            self.facts.extend(facts);
            if let Some(repeated) = repeated.filter(|_| counted) {
                let calibration = id;
                self.facts.push(Fact::Repeated {
                    calibration,
                    repeated,
                });
            }
            entry.pace.count(calibration.simulations, now_ms);
            counted
        });
        let convicted = calibration.take_convicted();
        let record = self
            .workers
            .get_mut(worker)
            .expect("the worker of an exchange is on record");
        let taken = match taken {
            Ok(true) => {
                record.completed += 1;
                self.counters.completed += 1;
                self.counters.completed_in_queues += u64::from(record.queue_job.is_some());
                Taken::New
            }
            Ok(false) => Taken::Duplicate,
            Err(message) => {
                record.faults += 1;
                self.counters.failed_leases += 1;
                if let Some(failure) = calibration.queue.fail(lease) {
                    calibration.drop_idle_seconds();
                    self.facts.extend(calibration.lease_failed(&failure, &message));
                } else if let Some(failure) = calibration
                    .second
                    .queue
                    .fail(lease)
                    .filter(LeaseFailure::exhausted)
                {
                    calibration.second.drop(failure.evaluation);
                }
                Taken::New
            }
        };
        for (worker, evaluation) in convicted {
            self.convict(&worker, id, evaluation);
        }
        self.settle(id, now_ms);
        taken
    }

    /// Key and model version of a calibration that takes no results: it has ended, or waits for its replay, after which a result
    /// counts where it is asked for again.
    fn closed(&self, id: i64) -> Option<Ended> {
        let Some(entry) = self.calibrations.get(&id) else {
            return self.ended.get(&id).cloned();
        };
        let calibration = &entry.calibration;
        let is_closed = entry.rewinds > 0 || calibration.state.is_final();
        is_closed.then(|| Ended {
            key: entry.key,
            model_version: calibration.model_version.clone().unwrap_or_default(),
            is_rewound: entry.rewinds > 0 || calibration.is_rewound,
        })
    }

    /// Lets the store compare a result that does not count.
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
        // After a rewind the same number may ask something else: what it asked before is not known.
        if let Some(computed) = SimulationResult::of(result).ok().filter(|_| !closed.is_rewound) {
            self.facts.push(Fact::Duplicate {
                calibration,
                evaluation,
                fingerprint: computed.fingerprint(),
                worker: worker.to_owned(),
            });
        }
        Taken::Duplicate
    }

    pub(super) fn give_back(&mut self, lease: u64, worker: &str) {
        self.queues().any(|queue| queue.give_back(lease, worker));
    }

    /// The queues of all calibrations.
    fn queues(&mut self) -> impl Iterator<Item = &mut LeaseQueue> {
        self.calibrations.values_mut().flat_map(Entry::queues)
    }

    pub(super) fn held_by(&self, worker: &str) -> usize {
        let held =
            |e: &Entry| e.calibration.queue.held_by(worker) + e.calibration.second.queue.held_by(worker);
        self.calibrations.values().map(held).sum()
    }

    /// Advances the clock: expires leases, removes silent workers, adds up busy time.
    pub fn tick(&mut self, now_ms: u64) {
        for entry in self.calibrations.values_mut() {
            self.counters.failed_leases += entry.calibration.second.expire(now_ms);
            let expired = entry.calibration.queue.expire(now_ms);
            entry.calibration.drop_idle_seconds();
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
        self.ask_beside_slow_workers(now_ms);
        for id in self.ids() {
            self.settle(id, now_ms);
        }
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
            let is_rewound = entry.calibration.is_rewound;
            let ended = Ended {
                key,
                model_version,
                is_rewound,
            };
            (id, ended)
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
            // Its replay asks for what is to be evaluated.
            (Control::Resume { .. }, CalibrationState::Paused) if entry.rewinds > 0 => {
                if std::mem::take(&mut entry.is_replay_due) {
                    self.rewinds.push(id);
                }
                calibration.change_state(CalibrationState::Running, None, &mut self.facts);
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
            .map(|e| progress::status(&e.calibration, &e.pace, e.rewinds > 0, now_ms))
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
            record.quarantined = self.quarantine.get(name).cloned();
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
pub(super) fn model_version<'a>(calibration: &'a Calibration, version: &str) -> Cow<'a, str> {
    match &calibration.model_version {
        Some(pinned) => Cow::Borrowed(pinned),
        None => Cow::Owned(calibration.spec.fit_variant.model_version(equations_of(version))),
    }
}
