//! The simulated coordinator: the real farm between a simulated network, a ledger and a witness.
//!
//! It does step by step what `farm::dispatch` and the store's writer do around the farm: it numbers facts in order, holds an answer back
//! until its facts are on disk, parks a worker that finds no work, and has the steps of engines taken, which come back in any order. Planted bugs act on the calls of the farm.

use std::collections::VecDeque;

use farm::calibration::{Step, VerificationRule};
use farm::{Control, Farm};
use record::{Fact, SealKey};
use shared::api::CalibrationState;
use shared::exchange::{ExchangeRequest, ExchangeResponse, WorkResult};

use super::case::{Case, EQUATIONS};
use super::ledger::{Entry, Ledger};
use super::plant::Plant;
use super::promise::{Broken, Promise, demand};
use super::request::bare;
use super::witness::{Source, Witness};

/// The duration of a lease without renewal `[ms]`.
pub(crate) const LEASE_MS: u64 = 1_000;

/// The receiver of an answer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Return {
    /// The index of the worker.
    pub(crate) worker: usize,
    /// The number of the exchange.
    pub(crate) exchange: u64,
}

/// An answer that waits for its facts.
#[derive(Debug)]
struct Held {
    /// The number of facts that must be on disk before the answer leaves.
    facts: usize,
    to: Return,
    worker: String,
    results: Vec<WorkResult>,
    response: ExchangeResponse,
}

/// A request of a worker that waits for work.
#[derive(Debug)]
struct Parked {
    request: ExchangeRequest,
    /// The results of the request, which the farm has taken.
    results: Vec<WorkResult>,
    until_ms: u64,
    to: Return,
}

/// The simulated coordinator.
#[derive(Debug)]
pub(crate) struct Coordinator<'a> {
    /// The farm; `None` while the coordinator is down.
    farm: Option<Farm>,
    epoch: u64,
    held: Vec<Held>,
    parked: VecDeque<Parked>,
    pub(crate) ledger: Ledger<'a>,
    pub(crate) witness: Witness<'a>,
    plant: Option<Plant>,
    /// Which evaluations a second worker computes.
    rule: VerificationRule,
    /// Calibrations to replay, each with the number of facts that must be on disk before.
    rewinds: Vec<(usize, i64)>,
    /// The steps of engines that are being taken.
    steps: Vec<Step>,
}

impl<'a> Coordinator<'a> {
    pub(crate) fn new(plant: Option<Plant>, verified_share: f64) -> Self {
        Coordinator {
            farm: Some(Farm::new(1, LEASE_MS).with_rule(VerificationRule::with_share(verified_share))),
            epoch: 1,
            held: Vec::new(),
            parked: VecDeque::new(),
            ledger: Ledger::default(),
            witness: Witness::new(LEASE_MS, verified_share > 0.0),
            plant,
            rule: VerificationRule::with_share(verified_share),
            rewinds: Vec::new(),
            steps: Vec::new(),
        }
    }

    fn has(&self, plant: Plant) -> bool {
        self.plant == Some(plant)
    }

    /// Returns whether the coordinator is running.
    pub(crate) fn is_up(&self) -> bool {
        self.farm.is_some()
    }

    /// Stores a new calibration and gives it to the farm.
    pub(crate) fn submit(
        &mut self,
        id: i64,
        case: &'a Case,
        key: SealKey,
        now_ms: u64,
    ) -> Result<(), Broken> {
        let key = if self.has(Plant::KeyAgain) {
            SealKey([id as u8; 16])
        } else {
            key
        };
        let Some(farm) = &mut self.farm else { return Ok(()) };
        self.ledger.push(Entry::Submitted { id, case, key });
        self.ledger.commit(usize::MAX);
        let calibration = case.begin(id).map_err(|e| Broken::new(Promise::Replay, e))?;
        let calibration = calibration.verified(&self.rule, key);
        farm.add(calibration, key, Vec::new(), now_ms);
        self.witness.began(id);
        self.take_facts(Source::Restart)
    }

    /// Writes the farm's facts into the ledger.
    fn take_facts(&mut self, source: Source) -> Result<(), Broken> {
        let Some(farm) = &mut self.farm else { return Ok(()) };
        let facts = farm.take_facts();
        let facts = match self.plant {
            Some(plant) => plant.facts(facts, &self.ledger),
            None => facts,
        };
        for fact in facts {
            self.witness.fact(&fact, source, &self.ledger)?;
            let rewound = match &fact {
                Fact::Rewound { calibration, .. } => Some(*calibration),
                _ => None,
            };
            self.ledger.push(Entry::Fact(fact));
            if let Some(id) = rewound {
                self.witness.rewound(id, &self.ledger);
            }
        }
        let stored = self.ledger.len();
        let rewinds = self.farm.iter_mut().flat_map(Farm::take_rewinds);
        self.rewinds.extend(rewinds.map(|id| (stored, id)));
        let steps = self.farm.iter_mut().flat_map(Farm::take_steps);
        self.steps.extend(steps);
        Ok(())
    }

    /// Returns the number of steps that are being taken.
    pub(crate) fn steps(&self) -> usize {
        self.steps.len()
    }

    /// Lets a step come back.
    pub(crate) fn step(&mut self, place: usize, now_ms: u64) -> Result<(), Broken> {
        let stepped = self.steps.swap_remove(place).run();
        if let Some(farm) = &mut self.farm {
            farm.stepped(stepped, now_ms);
        }
        self.take_facts(Source::Step)?;
        self.serve_parked(now_ms)
    }

    /// Handles a request that arrives.
    pub(crate) fn receive(
        &mut self,
        request: ExchangeRequest,
        to: Return,
        now_ms: u64,
    ) -> Result<(), Broken> {
        if self.farm.is_none() {
            return Ok(());
        }
        let response = self.exchange(&request, now_ms)?;
        if response.leases.is_empty() && request.want > 0 && request.wait_ms > 0 && response.refused.is_none()
        {
            let mut question = request;
            let results = std::mem::take(&mut question.results);
            question.holding.clear();
            question.returned.clear();
            question.started.clear();
            let until_ms = now_ms + question.wait_ms;
            self.parked.push_back(Parked {
                request: question,
                results,
                until_ms,
                to,
            });
        } else {
            self.hold(to, request.worker, request.results, response);
        }
        self.serve_parked(now_ms)
    }

    fn exchange(&mut self, request: &ExchangeRequest, now_ms: u64) -> Result<ExchangeResponse, Broken> {
        let planted = self.planted_request(request.clone(), now_ms)?;
        let farm = self
            .farm
            .as_mut()
            .expect("an exchange is with a coordinator that is up");
        let response = farm.exchange(planted, now_ms);
        self.take_facts(Source::Exchange(request))?;
        self.witness.exchanged(request, &response, &self.ledger, now_ms)?;
        Ok(response)
    }

    fn hold(&mut self, to: Return, worker: String, results: Vec<WorkResult>, response: ExchangeResponse) {
        self.held.push(Held {
            facts: self.ledger.len(),
            to,
            worker,
            results,
            response,
        });
    }

    fn serve_parked(&mut self, now_ms: u64) -> Result<(), Broken> {
        for _ in 0..self.parked.len() {
            let (Some(farm), Some(parked)) = (&self.farm, self.parked.pop_front()) else {
                return Ok(());
            };
            if !farm.has_work() && parked.until_ms > now_ms {
                self.parked.push_back(parked);
                continue;
            }
            let response = self.exchange(&parked.request, now_ms)?;
            if response.leases.is_empty() && parked.until_ms > now_ms && response.refused.is_none() {
                self.parked.push_back(parked);
            } else {
                self.hold(parked.to, parked.request.worker, parked.results, response);
            }
        }
        Ok(())
    }

    /// Lets time pass for the farm.
    pub(crate) fn tick(&mut self, now_ms: u64) -> Result<(), Broken> {
        if self.has(Plant::RenewedAfterExpiry) {
            self.renew_all(now_ms);
        }
        let ahead = if self.has(Plant::ExpiresEarly) {
            LEASE_MS / 2
        } else {
            0
        };
        let Some(farm) = &mut self.farm else { return Ok(()) };
        self.witness.tick(now_ms);
        farm.tick(now_ms + ahead);
        self.take_facts(Source::Tick)?;
        self.serve_parked(now_ms)
    }

    /// Brings more facts to disk. Returns the answers that may leave.
    pub(crate) fn commit(
        &mut self,
        facts: usize,
        now_ms: u64,
    ) -> Result<Vec<(Return, ExchangeResponse)>, Broken> {
        self.ledger.commit(facts);
        let stored = self.ledger.durable();
        let rewinds: Vec<(usize, i64)> = self
            .rewinds
            .extract_if(.., |(facts, _)| *facts <= stored)
            .collect();
        for (_, id) in rewinds {
            self.take_up(id, now_ms)?;
        }
        let early = self.has(Plant::AnswerBeforeDisk);
        let durable = self.ledger.durable();
        let leaving: Vec<Held> = self
            .held
            .extract_if(.., |held| early || held.facts <= durable)
            .collect();
        let mut answers = Vec::with_capacity(leaving.len());
        for held in leaving {
            self.witness
                .acknowledged(&held.worker, &held.results, &self.ledger)?;
            answers.push((held.to, held.response));
        }
        Ok(answers)
    }

    /// Executes a user's command, which is answered when it is on disk.
    pub(crate) fn control(&mut self, id: i64, control: Control, now_ms: u64) -> Result<(), Broken> {
        let is_lost = self.has(Plant::PauseLost) && control == Control::Pause;
        let Some(farm) = &mut self.farm else { return Ok(()) };
        let done = if is_lost {
            Ok(CalibrationState::Paused)
        } else {
            farm.control(id, control.clone(), now_ms)
        };
        self.take_facts(Source::Command)?;
        let Ok(state) = done else { return Ok(()) };
        if !self.has(Plant::CommandBeforeDisk) {
            self.ledger.commit(usize::MAX);
        }
        let stored = self.ledger.table(id).map(|table| table.state);
        let on_disk = stored == Some(state) && self.ledger.durable() == self.ledger.len();
        demand(on_disk, Promise::Acknowledged, || {
            format!("{control:?} of calibration {id} is acknowledged and not on disk")
        })?;
        self.serve_parked(now_ms)
    }

    /// Ends the coordinator: facts that are not on disk are lost. With a backup, facts after it are lost too.
    pub(crate) fn crash(&mut self, backup: Option<usize>) -> Result<(), Broken> {
        self.farm = None;
        self.held.clear();
        self.parked.clear();
        self.rewinds.clear();
        self.steps.clear();
        let durable = self.ledger.durable();
        if self.has(Plant::HoleInFacts) && durable + 1 < self.ledger.len() {
            self.ledger.lose(durable);
        }
        self.ledger.cut(backup.unwrap_or(self.ledger.durable()));
        self.witness.crashed(&self.ledger, backup.is_some())
    }

    /// Starts the coordinator and resumes the stored calibrations.
    pub(crate) fn restart(&mut self, now_ms: u64) -> Result<(), Broken> {
        if !self.has(Plant::FenceRepeats) {
            self.epoch += 1;
        }
        let quarantine = match self.has(Plant::QuarantineForgotten) {
            true => Vec::new(),
            false => self.ledger.quarantine().values().cloned().collect(),
        };
        let farm = Farm::new(self.epoch, LEASE_MS).with_rule(self.rule.clone());
        self.farm = Some(farm.with_quarantine(quarantine));
        let open = self
            .ledger
            .tables()
            .iter()
            .filter(|(_, table)| !table.state.is_final());
        let open: Vec<i64> = open.map(|(&id, _)| id).collect();
        open.into_iter().try_for_each(|id| self.take_up(id, now_ms))
    }

    /// Replays a calibration and gives it to the farm.
    fn take_up(&mut self, id: i64, now_ms: u64) -> Result<(), Broken> {
        let Some(table) = self.ledger.table(id) else {
            return Ok(());
        };
        let stored = match self.plant {
            Some(plant) => plant.replayed(table.stored()),
            None => table.stored(),
        };
        let key = table.key;
        let rule = self.rule.clone();
        let replayed = table.case.begin(id).and_then(|calibration| {
            let mut calibration = calibration.verified(&rule, key);
            let facts = calibration.replay(stored).map_err(|e| e.to_string())?;
            Ok((calibration, facts))
        });
        let (calibration, facts) = replayed.map_err(|e| Broken::new(Promise::Replay, e))?;
        self.witness.began(id);
        if let Some(farm) = &mut self.farm {
            farm.add(calibration, key, facts, now_ms);
        }
        self.take_facts(Source::Restart)
    }
}

/// The planted bugs that act on requests.
impl Coordinator<'_> {
    /// Returns the request that the farm gets under a planted bug.
    fn planted_request(
        &mut self,
        mut request: ExchangeRequest,
        now_ms: u64,
    ) -> Result<ExchangeRequest, Broken> {
        match self.plant {
            Some(Plant::TakenForLost) => request.received = 0,
            Some(Plant::RenewedIsStarted) => request.started.extend_from_slice(&request.holding),
            Some(Plant::StartUnread) => request.started.clear(),
            Some(Plant::VersionUnchecked) => request.model_version = EQUATIONS.into(),
            Some(Plant::SealUnchecked) => {
                for result in &mut request.results {
                    if let Some(issued) = self.witness.issued.get(&result.lease) {
                        result.seal.clone_from(&issued.lease.seal);
                    }
                }
            }
            Some(Plant::WorkerUnchecked | Plant::ReturnedByOthers) => {
                self.in_the_name_of_others(&request, now_ms)?
            }
            _ => {}
        }
        Ok(request)
    }

    /// Lets a worker act on the leases of others, as if the names of workers were not compared.
    fn in_the_name_of_others(&mut self, request: &ExchangeRequest, now_ms: u64) -> Result<(), Broken> {
        let owner = |lease: u64| Some(self.witness.issued.get(&lease)?.worker.clone());
        let mut acts: Vec<ExchangeRequest> = Vec::new();
        let emptied = |worker: String| ExchangeRequest {
            worker,
            results: Vec::new(),
            holding: Vec::new(),
            returned: Vec::new(),
            started: Vec::new(),
            received: u64::MAX,
            want: 0,
            ..request.clone()
        };
        if self.has(Plant::ReturnedByOthers) {
            for &lease in &request.returned {
                acts.extend(owner(lease).map(|worker| ExchangeRequest {
                    returned: vec![lease],
                    ..emptied(worker)
                }));
            }
        } else {
            for result in &request.results {
                acts.extend(owner(result.lease).map(|worker| ExchangeRequest {
                    results: vec![result.clone()],
                    ..emptied(worker)
                }));
            }
        }
        for act in acts.into_iter().filter(|act| act.worker != request.worker) {
            if let Some(farm) = &mut self.farm {
                farm.exchange(act, now_ms);
            }
            self.take_facts(Source::Exchange(request))?;
        }
        Ok(())
    }

    /// Renews every lease that is out, in its worker's name.
    fn renew_all(&mut self, now_ms: u64) {
        let Some(farm) = &mut self.farm else { return };
        for (lease, worker) in self.witness.live() {
            let renewal = ExchangeRequest {
                holding: vec![lease],
                ..bare(worker.to_owned(), EQUATIONS)
            };
            farm.exchange(renewal, now_ms);
        }
    }
}
