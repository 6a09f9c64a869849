//! The farm: all calibrations in progress and all connected workers, and the assignment of evaluations to workers.

use std::collections::{BTreeMap, BTreeSet};

use shared::api::{CalibrationState, CalibrationStatus};
use shared::exchange::{ExchangeRequest, ExchangeResponse};
use shared::model::{ModelVariant, equations_of};

use super::control::{Control, ControlError};
use super::lease_numbers::LeaseNumbers;
use super::metrics::{FarmCounters, FarmMetrics};
use super::progress::{self, Pace};
use super::replay_cause::ReplayCause;
use super::worker_record::WorkerRecord;
use crate::calibration::{Calibration, VerificationRule};
use crate::lease::LeaseQueue;
use record::SealKey;
use record::fact::Fact;

/// The time after its last message for which a worker counts as connected `[ms]`.
const WORKER_SILENCE_MS: u64 = 60_000;

/// All calibrations in progress and all connected workers.
#[derive(Debug)]
pub struct Farm {
    pub(super) calibrations: BTreeMap<i64, Entry>,
    /// Calibrations that have ended since the start. Their late results are compared.
    pub(super) ended: BTreeMap<i64, Ended>,
    pub(super) workers: BTreeMap<String, WorkerRecord>,
    /// Workers that compute wrongly, with the reason.
    pub(super) quarantine: BTreeMap<String, String>,
    /// The connected workers that are quarantined.
    pub(super) shut_out: BTreeSet<String>,
    /// Calibrations to replay without the results of quarantined workers, since the last call of [`Farm::take_rewinds`].
    pub(super) rewinds: Vec<i64>,
    pub(super) counters: FarmCounters,
    pub(super) facts: Vec<Fact>,
    pub(super) lease_numbers: LeaseNumbers,
    /// The number of the last step of an engine.
    pub(super) last_step: u64,
    pub(super) lease_ms: u64,
    pub(super) rule: VerificationRule,
}

#[derive(Debug)]
pub(super) struct Entry {
    pub(super) calibration: Calibration,
    pub(super) key: SealKey,
    pub(super) pace: Pace,
    /// The number of replays that the calibration waits for. It gives out no lease and takes no result before the last replay.
    pub(super) rewinds: u32,
    /// Whether the last replay failed, so that a user has to ask for another.
    pub(super) is_replay_due: bool,
    /// The cause of the last replay that was asked for, which says why one that fails matters.
    pub(super) replay_cause: ReplayCause,
    /// When busy time was last added up `[ms]`.
    counted_ms: u64,
}

impl Entry {
    fn queues(&mut self) -> [&mut LeaseQueue; 2] {
        let Calibration { queue, witness, .. } = &mut self.calibration;
        [queue, &mut witness.second.queue]
    }
}

/// A calibration that takes no results, with the data that check its late results.
#[derive(Debug, Clone)]
pub(super) struct Ended {
    pub(super) key: SealKey,
    pub(super) model_version: String,
    pub(super) is_rewound: bool,
}

impl Farm {
    /// Makes an empty farm; `epoch` numbers the starts of the coordinator, so lease numbers never repeat.
    pub fn new(epoch: u64, lease_ms: u64) -> Self {
        Farm {
            calibrations: BTreeMap::new(),
            ended: BTreeMap::new(),
            workers: BTreeMap::new(),
            quarantine: BTreeMap::new(),
            shut_out: BTreeSet::new(),
            rewinds: Vec::new(),
            counters: FarmCounters::default(),
            facts: Vec::new(),
            lease_numbers: LeaseNumbers::new(epoch),
            last_step: 0,
            lease_ms,
            rule: VerificationRule::default(),
        }
    }

    /// Makes the farm compare answers by a rule, by which its calibrations are verified, too.
    #[must_use]
    pub fn with_rule(self, rule: VerificationRule) -> Self {
        Farm { rule, ..self }
    }

    /// Adds a calibration, with facts of its replay that may have been lost. A calibration that was replayed because a worker computes
    /// wrongly replaces its former state.
    pub fn add(&mut self, mut calibration: Calibration, key: SealKey, facts: Vec<Fact>, now_ms: u64) {
        let id = calibration.identity.id;
        if self.ended.contains_key(&id) {
            // The calibration was cancelled while it was replayed.
            return;
        }
        if let Some(before) = self.calibrations.get_mut(&id) {
            before.rewinds = before.rewinds.saturating_sub(1);
            if before.rewinds > 0 {
                // The replay has read results that have been dropped since.
                return;
            }
            // A user's commands during the replay take effect.
            if !calibration.state.is_final() {
                calibration.state = before.calibration.state;
                calibration.message.clone_from(&before.calibration.message);
            }
            calibration.cost.busy_ms = before.calibration.cost.busy_ms;
        }
        self.facts.extend(facts);
        let pace = Pace::new(calibration.cost.simulations, now_ms);
        let entry = Entry {
            calibration,
            key,
            pace,
            rewinds: 0,
            is_replay_due: false,
            replay_cause: ReplayCause::Worker,
            counted_ms: now_ms,
        };
        self.calibrations.insert(entry.calibration.identity.id, entry);
        // The replay may have ended the calibration. Its late results are compared from now on.
        self.account(now_ms);
    }

    /// Returns the facts since the last call, in order.
    pub fn take_facts(&mut self) -> Vec<Fact> {
        std::mem::take(&mut self.facts)
    }

    /// Returns numbers for the metrics page.
    pub fn metrics(&self) -> FarmMetrics {
        let leased = |e: &Entry| e.calibration.queue.leased() + e.calibration.witness.second.queue.leased();
        let waiting = |e: &Entry| e.calibration.witness.second.waiting();
        FarmMetrics {
            counters: self.counters.clone(),
            queued: self.remaining(),
            leased: self.calibrations.values().map(leased).sum(),
            calibrations: self.calibrations.len(),
            workers: self.workers.len(),
            unconfirmed: self.calibrations.values().map(waiting).sum(),
            quarantined: self.quarantine.len(),
            stepping: self
                .calibrations
                .values()
                .filter(|e| e.calibration.is_stepping())
                .count(),
        }
    }

    /// Returns whether an exchange would give some worker a lease.
    pub fn has_work(&self) -> bool {
        let second = |e: &Entry| e.calibration.is_open() && e.calibration.witness.second.queue.unleased() > 0;
        self.remaining() > 0 || self.calibrations.values().any(second)
    }

    /// Returns the number of workers that are not quarantined. Every exchange calls this function, so it loops over no workers.
    pub(super) fn able_workers(&self) -> usize {
        self.workers.len() - self.shut_out.len()
    }

    fn remaining(&self) -> u64 {
        let open = self.calibrations.values().filter(|e| e.calibration.is_open());
        open.map(|e| e.calibration.queue.unleased() as u64).sum()
    }

    /// Takes a worker's results, renewals and returns, and leases up to the wanted number of evaluations.
    pub fn exchange(&mut self, mut request: ExchangeRequest, now_ms: u64) -> ExchangeResponse {
        let has_lost = self.note_worker(&request, now_ms);
        let results = std::mem::take(&mut request.results);
        let duplicates = self.take_results(&request.worker, results, now_ms);
        let worker = &request.worker;
        let until_ms = now_ms + self.lease_ms;
        for &lease in &request.holding {
            self.queues().any(|queue| queue.renew(lease, worker, until_ms));
        }
        for &lease in &request.started {
            self.queues().any(|queue| queue.start(lease, worker, until_ms));
        }
        if has_lost {
            let take_back = |q: &mut LeaseQueue| q.take_back_above(request.received, worker);
            self.counters.lost += self.queues().map(take_back).sum::<u64>();
        }
        for &lease in &request.returned {
            self.give_back(lease, worker);
        }
        for entry in self.calibrations.values_mut() {
            entry.calibration.drop_idle_seconds();
        }
        self.account(now_ms);
        // A result of this message may have caused the quarantine of the worker.
        let (leases, refused) = match self.quarantined(worker) {
            Some(reason) => (Vec::new(), Some(reason.clone())),
            None => self.lease(worker, request.want as usize, now_ms),
        };
        let open = self.calibrations.values().filter(|e| e.calibration.is_open());
        ExchangeResponse {
            leases,
            lease_ms: self.lease_ms,
            remaining: self.remaining(),
            in_hand: open.count() as u64,
            workers: self.able_workers() as u32,
            duplicates,
            refused,
        }
    }

    /// Records a worker. Returns whether leases were lost: the worker sends a message without having received them.
    fn note_worker(&mut self, request: &ExchangeRequest, now_ms: u64) -> bool {
        if !self.workers.contains_key(&request.worker) && self.quarantined(&request.worker).is_some() {
            self.shut_out.insert(request.worker.clone());
        }
        let record = self.workers.entry(request.worker.clone());
        let record = record.or_insert_with(|| WorkerRecord {
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
        // The last message decides, so that no evaluation waits for a worker that has changed its version.
        record.model_version.clone_from(&request.model_version);
        record.models.clone_from(&request.models);
        record.evaluation_s = request.evaluation_s;
        let has_lost = request.received < record.given;
        record.given = record.given.min(request.received);
        has_lost
    }

    pub(super) fn give_back(&mut self, lease: u64, worker: &str) {
        self.queues().any(|queue| queue.give_back(lease, worker));
    }

    /// Returns the queues of all calibrations.
    fn queues(&mut self) -> impl Iterator<Item = &mut LeaseQueue> {
        self.calibrations.values_mut().flat_map(Entry::queues)
    }

    pub(super) fn held_by(&self, worker: &str) -> usize {
        let held = |e: &Entry| {
            e.calibration.queue.held_by(worker) + e.calibration.witness.second.queue.held_by(worker)
        };
        self.calibrations.values().map(held).sum()
    }

    /// Advances the clock: expires leases, removes silent workers, adds up busy time.
    pub fn tick(&mut self, now_ms: u64) {
        for entry in self.calibrations.values_mut() {
            self.counters.failed_leases += entry.calibration.witness.second.expire(now_ms);
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
        self.shut_out.retain(|name| self.workers.contains_key(name));
        self.ask_beside_slow_workers(now_ms);
        for id in self.ids() {
            self.settle(id, now_ms);
            self.finish_if_compared(id, now_ms);
        }
        self.account(now_ms);
    }

    /// Adds up busy time and removes finished calibrations.
    pub(super) fn account(&mut self, now_ms: u64) {
        for entry in self.calibrations.values_mut() {
            // A calibration without leases has no cost.
            let calibration = &entry.calibration;
            if calibration.state == CalibrationState::Running && calibration.queue.leased() > 0 {
                entry.calibration.cost.busy_ms += now_ms.saturating_sub(entry.counted_ms);
            }
            entry.counted_ms = now_ms;
        }
        let ended = self
            .calibrations
            .extract_if(.., |_, e| e.calibration.state.is_final());
        self.ended.extend(ended.map(|(id, entry)| {
            let model_version = entry.calibration.model_version.unwrap_or_default();
            let key = entry.key;
            let is_rewound = entry.calibration.witness.is_rewound;
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
            // The replay will ask for the evaluations.
            (Control::Resume { .. }, CalibrationState::Paused) if entry.rewinds > 0 => {
                if std::mem::take(&mut entry.is_replay_due) {
                    self.rewinds.push(id);
                }
                calibration.change_state(CalibrationState::Running, None, &mut self.facts);
            }
            (Control::Resume { skip_faults }, CalibrationState::Paused) => {
                calibration.resume(skip_faults, &mut self.facts);
            }
            (
                Control::ComputeWith(stated),
                CalibrationState::Queued | CalibrationState::Running | CalibrationState::Paused,
            ) => {
                let equations = equations_of(&stated);
                let version = calibration.spec.fit_variant.model_version(equations);
                let is_pinned = calibration.model_version.as_ref() == Some(&version);
                if !is_pinned {
                    let connected = connected_versions(&self.workers, &self.shut_out, calibration);
                    // A mistyped version would drop every result, and nobody would compute on.
                    if !connected.contains(equations) {
                        return Err(ControlError::NoSuchVersion {
                            connected: connected.into_iter().map(str::to_owned).collect(),
                            version: stated,
                        });
                    }
                }
                match state {
                    _ if !is_pinned => self.repin(id, version),
                    CalibrationState::Paused => {
                        return self.control(id, Control::Resume { skip_faults: false }, now_ms);
                    }
                    _ => {}
                }
            }
            (Control::Pause, _) => {
                return Err(ControlError::WrongState {
                    id,
                    state,
                    verb: "paused",
                });
            }
            (Control::Resume { .. } | Control::ComputeWith(_), _) => {
                return Err(ControlError::WrongState {
                    id,
                    state,
                    verb: "resumed",
                });
            }
        }
        let state = self
            .calibrations
            .get(&id)
            .map_or(state, |entry| entry.calibration.state);
        self.account(now_ms);
        Ok(state)
    }

    /// Returns the status of a calibration in progress.
    pub fn status(&self, id: i64, now_ms: u64) -> Option<CalibrationStatus> {
        self.calibrations
            .get(&id)
            .map(|e| progress::status(&e.calibration, &e.pace, e.rewinds > 0, now_ms))
    }

    /// Returns the ids of the calibrations in progress.
    pub fn ids(&self) -> Vec<i64> {
        self.calibrations.keys().copied().collect()
    }

    /// Returns the connected workers.
    pub fn workers(&self, now_ms: u64) -> BTreeMap<String, WorkerRecord> {
        let mut workers = self.workers.clone();
        for (name, record) in &mut workers {
            record.holds = self.held_by(name) as u64;
            record.silent_ms = now_ms.saturating_sub(record.last_seen_ms);
            record.quarantined = self.quarantined(name).cloned();
        }
        workers
    }

    /// Returns the variant with a hash, if a calibration in progress uses it.
    pub fn variant(&self, hash: &str) -> Option<ModelVariant> {
        self.calibrations
            .values()
            .find_map(|e| e.calibration.variant(hash))
            .cloned()
    }
}

/// Returns the versions of the equations with which connected workers compute a calibration, without those of quarantined workers.
fn connected_versions<'a>(
    workers: &'a BTreeMap<String, WorkerRecord>,
    shut_out: &BTreeSet<String>,
    calibration: &Calibration,
) -> BTreeSet<&'a str> {
    let able = workers.iter().filter(|(name, _)| !shut_out.contains(*name));
    able.filter_map(|(_, worker)| worker.equations_for(calibration))
        .map(equations_of)
        .collect()
}
