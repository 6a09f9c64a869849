//! One schedule: a farm, its workers and a network under faults, and then a calm end.
//!
//! All events are drawn from one random stream, which depends on the seed alone. In every step one event happens: a worker acts, a message
//! arrives, facts come to disk, time passes, or something breaks. After the faults the schedule is calm, and every calibration must end.

use farm::Control;
use record::SealKey;
use shared::api::CalibrationState;
use shared::exchange::{ExchangeRequest, ExchangeResponse, WorkResult};
use statistics::rng::Stream;

use super::case::{Case, EQUATIONS, Kind};
use super::coordinator::{Coordinator, LEASE_MS, Return};
use super::issued::Issued;
use super::plant::Plant;
use super::promise::{Broken, Promise};
use super::request::bare;
use super::tally::Tally;
use super::weather::{Weather, chance};
use super::worker::{Act, Worker, lie};

/// The version of the equations of workers that cannot continue a calibration of other workers.
const OTHER_EQUATIONS: &str = "scm-5";
/// The number of calm steps within which every calibration must end.
const MAX_CALM_STEPS: u64 = 40_000;
/// The number of steps after the end, for messages that are still on their way.
const STEPS_AFTER: u64 = 20;
/// The probability that one of the steps of engines that are being taken comes back before the next event.
const STEP_BACK: f64 = 0.2;
/// The stage of the random streams, which no sampler uses.
const STAGE: u64 = 1 << 41;
/// The index of a sender that expects no answer.
const NOBODY: usize = usize::MAX;

/// A message on its way.
#[derive(Debug)]
enum Message {
    Request(ExchangeRequest, Return),
    Answer(ExchangeResponse, Return),
}

/// Prints the events, if it is on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Journal(pub(crate) bool);

impl Journal {
    fn note(self, now_ms: u64, what: impl FnOnce() -> String) {
        if self.0 {
            println!("{now_ms:>9} ms  {}", what());
        }
    }
}

struct Schedule<'a> {
    cases: &'a [Vec<Case>],
    stream: Stream,
    weather: Weather,
    journal: Journal,
    coordinator: Coordinator<'a>,
    workers: Vec<Worker>,
    births: u64,
    /// Messages on their way, each with the earliest time of its arrival.
    network: Vec<(u64, Message)>,
    now_ms: u64,
    /// The number of entries in the backup.
    backup: Option<usize>,
    /// The number of calibrations that users submit.
    calibrations: i64,
    /// Whether every evaluation is verified.
    verifies: bool,
    is_calm: bool,
    tally: Tally,
}

/// Runs the schedule of a seed.
///
/// # Errors
/// The broken promise.
pub(crate) fn run(
    cases: &[Vec<Case>],
    seed: u64,
    plant: Option<Plant>,
    journal: Journal,
) -> Result<Tally, Broken> {
    let mut stream = Stream::new(seed, STAGE, 0, 0);
    let weather = Weather::draw(&mut stream);
    // Every evaluation is verified, or none.
    let verified_share = f64::from(u8::from(chance(&mut stream, 0.5)));
    journal.note(0, || format!("schedule {seed}: {weather:?}"));
    let mut schedule = Schedule {
        cases,
        weather,
        journal,
        coordinator: Coordinator::new(plant, verified_share),
        workers: Vec::new(),
        births: 0,
        network: Vec::new(),
        now_ms: 0,
        backup: None,
        calibrations: 1 + i64::from(chance(&mut stream, 0.3)),
        verifies: verified_share > 0.0,
        is_calm: false,
        tally: Tally::default(),
        stream,
    };
    let result = schedule.run();
    if let Err(broken) = &result {
        journal.note(schedule.now_ms, || format!("BROKEN PROMISE {broken}"));
    }
    result.map(|()| schedule.tally)
}

impl Schedule<'_> {
    fn run(&mut self) -> Result<(), Broken> {
        self.submit(1)?;
        for _ in 0..1 + self.stream.below(4) {
            let is_other = chance(&mut self.stream, 0.1);
            let worker = self.hire(if is_other { OTHER_EQUATIONS } else { EQUATIONS });
            self.workers.push(worker);
        }
        let rough = 30 + self.stream.below(250) as u64;
        let mut after = STEPS_AFTER;
        for step in 0..rough + MAX_CALM_STEPS {
            if step == rough {
                self.calm();
            }
            self.step()?;
            self.tally.steps += 1;
            if self.coordinator.witness.is_given_up {
                self.tally.given_up += 1;
                return self.end();
            }
            if self.is_over() {
                after -= 1;
                if after == 0 {
                    return self.end();
                }
            }
        }
        Err(Broken::new(
            Promise::End,
            format!("not over after {MAX_CALM_STEPS} steps without a fault"),
        ))
    }

    fn end(&mut self) -> Result<(), Broken> {
        let tables = self.coordinator.ledger.tables();
        let in_state = |state| tables.values().filter(|t| t.state == state).count() as u64;
        self.tally.schedules = 1;
        self.tally.finished = in_state(CalibrationState::Finished);
        self.tally.cancelled = in_state(CalibrationState::Cancelled);
        self.tally.rows = tables.values().map(|t| t.rows.len() as u64).sum();
        self.tally.disputes = tables.values().map(|t| t.disputes.len() as u64).sum();
        self.tally.confirmed = tables.values().map(|t| t.confirmed.len() as u64).sum();
        self.tally.quarantined = self.coordinator.ledger.quarantine().len() as u64;
        self.tally.leases = self.coordinator.witness.issued.len() as u64;
        Ok(())
    }

    fn is_over(&self) -> bool {
        let ledger = &self.coordinator.ledger;
        self.coordinator.is_up()
            && ledger.durable() == ledger.len()
            && ledger.tables().len() as i64 == self.calibrations
            && ledger.tables().values().all(|table| table.state.is_final())
    }

    /// Begins the calm end: only poisonous evaluations fail, and there is a worker for every pinned version.
    fn calm(&mut self) {
        self.is_calm = true;
        self.weather = Weather::default();
        for worker in &mut self.workers {
            worker.stopped_until_ms = 0;
        }
        for version in [EQUATIONS, OTHER_EQUATIONS] {
            let worker = self.hire(version);
            self.workers.push(worker);
        }
        self.journal.note(self.now_ms, || "calm".into());
    }

    fn step(&mut self) -> Result<(), Broken> {
        self.now_ms += self.stream.below(40) as u64;
        // Steps come back late and in any order.
        let steps = self.coordinator.steps();
        if steps > 0 && chance(&mut self.stream, STEP_BACK) {
            let place = self.stream.below(steps);
            self.coordinator.step(place, self.now_ms)?;
        }
        match self.stream.below(100) {
            0..42 => self.act(),
            42..72 => {
                let max_messages = if self.is_calm {
                    usize::MAX
                } else {
                    1 + self.stream.below(4)
                };
                (0..self.network.len().min(max_messages)).try_for_each(|_| self.deliver())
            }
            72..86 => {
                let facts = if self.is_calm {
                    usize::MAX
                } else {
                    1 + self.stream.below(6)
                };
                self.commit(facts)
            }
            86..92 => self.coordinator.tick(self.now_ms),
            _ if self.is_calm => self.mend(),
            _ => self.break_something(),
        }
    }

    fn submit(&mut self, id: i64) -> Result<(), Broken> {
        let mut drawn = self.stream.below(100);
        let kind = Kind::SHARES
            .iter()
            .position(|&(_, share)| match drawn.checked_sub(share) {
                None => true,
                Some(rest) => {
                    drawn = rest;
                    false
                }
            });
        let of_kind = &self.cases[kind.expect("the shares are of a hundred")];
        let case = &of_kind[self.stream.below(of_kind.len())];
        let key = SealKey(std::array::from_fn(|_| self.stream.below(256) as u8));
        self.journal.note(self.now_ms, || {
            format!("calibration {id} is submitted: {:?}", case.kind)
        });
        self.coordinator.submit(id, case, key, self.now_ms)
    }

    /// Makes a new worker process.
    fn hire(&mut self, version: &'static str) -> Worker {
        self.births += 1;
        Worker::new(self.births, version, &mut self.stream)
    }

    fn send(&mut self, message: Message) {
        if chance(&mut self.stream, self.weather.loss) {
            self.tally.lost += 1;
            return;
        }
        let mut at_ms = self.now_ms;
        if chance(&mut self.stream, self.weather.delay) {
            self.tally.delayed += 1;
            at_ms += LEASE_MS + self.stream.below(LEASE_MS as usize) as u64;
        }
        if let Message::Request(request, to) = &message
            && chance(&mut self.stream, self.weather.twice)
        {
            self.tally.twice += 1;
            let again_ms = self.now_ms + self.stream.below(LEASE_MS as usize) as u64;
            self.network
                .push((again_ms, Message::Request(request.clone(), *to)));
        }
        self.network.push((at_ms, message));
    }

    fn act(&mut self) -> Result<(), Broken> {
        let place = self.stream.below(self.workers.len());
        let issued = &self.coordinator.witness.issued;
        let act = self.workers[place].act(issued, &self.weather, &mut self.stream, self.now_ms);
        match act {
            Act::Nothing => {}
            Act::Die => self.kill(place),
            Act::Send(exchange, request) => {
                self.journal.note(self.now_ms, || said(&request));
                self.send(Message::Request(
                    *request,
                    Return {
                        worker: place,
                        exchange,
                    },
                ));
            }
        }
        Ok(())
    }

    fn kill(&mut self, place: usize) {
        self.tally.deaths += 1;
        let worker = self.hire(self.workers[place].version);
        self.journal.note(self.now_ms, || {
            format!("{} dies, {} comes", self.workers[place].name, worker.name)
        });
        self.workers[place] = worker;
    }

    fn deliver(&mut self) -> Result<(), Broken> {
        if self.network.is_empty() {
            return Ok(());
        }
        let place = self.stream.below(self.network.len());
        if self.network[place].0 > self.now_ms {
            return Ok(());
        }
        match self.network.swap_remove(place).1 {
            // A lie as the first answer would lead to questions that the run without faults never asks.
            Message::Request(request, _) if self.is_first_lie(&request) => Ok(()),
            Message::Request(request, to) => self.coordinator.receive(request, to, self.now_ms),
            Message::Answer(response, to) => {
                if let Some(worker) = self.workers.get_mut(to.worker) {
                    self.journal.note(self.now_ms, || heard(&worker.name, &response));
                    worker.accept(to.exchange, response);
                }
                Ok(())
            }
        }
    }

    /// Returns whether a request contains a worker's lie about an evaluation without a row.
    fn is_first_lie(&self, request: &ExchangeRequest) -> bool {
        let Coordinator { ledger, witness, .. } = &self.coordinator;
        let is_lie = |r: &WorkResult| {
            let honest = witness.issued.get(&r.lease).map(Issued::answer);
            honest.is_some_and(|honest| honest.outcome != r.outcome)
                && ledger.row(r.calibration, r.evaluation).is_none()
        };
        self.verifies && witness.liars.contains(&request.worker) && request.results.iter().any(is_lie)
    }

    fn commit(&mut self, facts: usize) -> Result<(), Broken> {
        for (to, response) in self.coordinator.commit(facts, self.now_ms)? {
            self.send(Message::Answer(response, to));
        }
        Ok(())
    }

    /// Repairs what faults have left: the coordinator runs, and paused calibrations are resumed.
    fn mend(&mut self) -> Result<(), Broken> {
        if !self.coordinator.is_up() {
            return self.restart();
        }
        self.submit_next()?;
        let tables = self.coordinator.ledger.tables();
        let paused = tables
            .iter()
            .find(|(_, table)| table.state == CalibrationState::Paused);
        let Some((&id, table)) = paused else { return Ok(()) };
        let mut exhausted = table.failed.iter().filter(|(_, workers)| workers.len() >= 3);
        let skip_faults = exhausted.all(|(evaluation, _)| table.case.poison == Some(*evaluation));
        self.control(id, Control::Resume { skip_faults })
    }

    fn submit_next(&mut self) -> Result<(), Broken> {
        // Later submissions are newer than the backup.
        self.backup.get_or_insert(self.coordinator.ledger.durable());
        let stored = self.coordinator.ledger.tables().len() as i64;
        if stored < self.calibrations {
            self.submit(stored + 1)
        } else {
            Ok(())
        }
    }

    fn control(&mut self, id: i64, control: Control) -> Result<(), Broken> {
        self.tally.commands += 1;
        self.journal
            .note(self.now_ms, || format!("a user: {control:?} of calibration {id}"));
        self.coordinator.control(id, control, self.now_ms)
    }

    fn restart(&mut self) -> Result<(), Broken> {
        self.journal.note(self.now_ms, || "the coordinator starts".into());
        self.coordinator.restart(self.now_ms)
    }

    fn break_something(&mut self) -> Result<(), Broken> {
        if !self.coordinator.is_up() {
            return self.restart();
        }
        let place = self.stream.below(self.workers.len());
        let Weather {
            crash,
            restore,
            death,
            stop,
            jump,
            user,
            cancel,
            forged,
            lie,
            ..
        } = self.weather;
        if chance(&mut self.stream, crash) {
            let backup = self.backup.filter(|_| chance(&mut self.stream, restore));
            self.tally.crashes += 1;
            self.tally.restores += u64::from(backup.is_some());
            let (stored, written) = (self.coordinator.ledger.durable(), self.coordinator.ledger.len());
            self.journal.note(self.now_ms, || match backup {
                None => format!("the coordinator dies with {stored} of {written} facts on disk"),
                Some(facts) => {
                    format!("the coordinator dies; a backup of {facts} facts is put back for {stored}")
                }
            });
            self.coordinator.crash(backup)?;
        }
        if chance(&mut self.stream, if self.backup.is_none() { 0.3 } else { 0.05 }) {
            self.backup = Some(self.coordinator.ledger.durable());
        }
        if chance(&mut self.stream, death) {
            self.kill(place);
        }
        if chance(&mut self.stream, stop) {
            self.tally.stops += 1;
            self.workers[place].stopped_until_ms = self.now_ms + 2 * LEASE_MS;
            self.journal
                .note(self.now_ms, || format!("{} is stopped", self.workers[place].name));
        }
        if chance(&mut self.stream, jump) {
            self.tally.jumps += 1;
            self.now_ms += LEASE_MS << self.stream.below(20);
            self.journal.note(self.now_ms, || "the clock has jumped".into());
        }
        if chance(&mut self.stream, 0.3) {
            self.submit_next()?;
        }
        let id = 1 + self.stream.below(self.calibrations as usize) as i64;
        if chance(&mut self.stream, user) {
            let pauses = chance(&mut self.stream, 0.5);
            let resume = Control::Resume { skip_faults: false };
            self.control(id, if pauses { Control::Pause } else { resume })?;
        }
        if chance(&mut self.stream, cancel) {
            self.control(id, Control::Cancel)?;
        }
        if chance(&mut self.stream, forged) {
            self.forge(place);
        }
        if chance(&mut self.stream, lie) {
            self.lie(place);
        }
        Ok(())
    }

    /// Sends an acknowledged result again with other values.
    fn lie(&mut self, place: usize) {
        // There is one liar in a schedule, because two could agree.
        let liars = &self.coordinator.witness.liars;
        if self.verifies && !liars.is_empty() && !liars.contains(&self.workers[place].name) {
            return;
        }
        let Some(again_ms) = self.workers[place].sent.as_ref().and_then(lie) else {
            return;
        };
        self.tally.lies += 1;
        self.coordinator
            .witness
            .liars
            .insert(self.workers[place].name.clone());
        let request = bare(self.workers[place].name.clone(), self.workers[place].version);
        self.inject(ExchangeRequest {
            results: vec![again_ms],
            ..request
        });
    }

    /// Sends a result or a return of a lease of another worker, or of another lease.
    fn forge(&mut self, place: usize) {
        let issued = &self.coordinator.witness.issued;
        let Some(theirs) = issued.values().nth(self.stream.below(issued.len())) else {
            return;
        };
        let Some(mut result) = lie(&theirs.answer()) else {
            return;
        };
        let (owner, version) = (theirs.worker.clone(), theirs.version.clone());
        let stranger = || format!("{owner}'");
        let request = match self.stream.below(4) {
            0 => {
                result.evaluation ^= 1;
                ExchangeRequest {
                    results: vec![result],
                    ..bare(owner, &version)
                }
            }
            1 => {
                result.seal = result.seal.chars().rev().collect();
                ExchangeRequest {
                    results: vec![result],
                    ..bare(owner, &version)
                }
            }
            2 => ExchangeRequest {
                results: vec![result],
                ..bare(stranger(), EQUATIONS)
            },
            _ => {
                let leases: Vec<u64> = self.coordinator.witness.live().map(|(lease, _)| lease).collect();
                let name = self.workers[place].name.clone();
                let foreign = self
                    .coordinator
                    .witness
                    .live()
                    .filter(|(_, worker)| *worker != name);
                let returned = foreign.map(|(lease, _)| lease).collect();
                ExchangeRequest {
                    returned,
                    started: leases.clone(),
                    holding: leases,
                    ..bare(stranger(), EQUATIONS)
                }
            }
        };
        self.tally.forged += 1;
        self.inject(request);
    }

    fn inject(&mut self, request: ExchangeRequest) {
        self.journal
            .note(self.now_ms, || format!("not to be believed: {}", said(&request)));
        let to = Return {
            worker: NOBODY,
            exchange: 0,
        };
        self.send(Message::Request(request, to));
    }
}

fn said(request: &ExchangeRequest) -> String {
    let results = request
        .results
        .iter()
        .map(|r| format!("{}.{} by {}", r.calibration, r.evaluation, r.lease));
    format!(
        "{} sends {:?}, holds {:?}, has begun {:?}, returns {:?}, has received {}, wants {}",
        request.worker,
        results.collect::<Vec<_>>(),
        request.holding,
        request.started,
        request.returned,
        request.received,
        request.want
    )
}

fn heard(worker: &str, response: &ExchangeResponse) -> String {
    let leases = response
        .leases
        .iter()
        .map(|l| format!("{}.{} by {}", l.calibration, l.evaluation, l.lease));
    format!("{worker} is given {:?}", leases.collect::<Vec<_>>())
}
