//! The witness of a schedule: it checks everything that reaches and leaves the farm against the promises.

use std::collections::{BTreeMap, BTreeSet};

use farm::calibration::SimulationResult;
use record::{EvaluationRow, Fact};
use shared::api::CalibrationState;
use shared::exchange::{ExchangeRequest, WorkResult};
use shared::model::equations_of;
use shared::outcome::Outcome;

use super::case::{CaseResult, posterior_bits, same_row, stage_bits};
use super::issued::{Issued, Live};
use super::ledger::{Ledger, Table, calibration_of};
use super::promise::{Broken, Promise, demand};

/// The number of failed attempts after which a calibration pauses.
const ATTEMPTS: usize = 3;
/// The number of leases in a row that expire before they are begun, after which a calibration pauses.
const UNSTARTED: u32 = 20;

/// The origin of a fact.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Source<'b> {
    /// A worker's exchange.
    Exchange(&'b ExchangeRequest),
    /// The passing of time.
    Tick,
    /// A user's command.
    Command,
    /// A replay.
    Restart,
    /// A step of an engine.
    Step,
}

/// The checks of everything that reaches and leaves the farm.
#[derive(Debug)]
pub(crate) struct Witness<'a> {
    /// Every lease that was ever given, by number.
    pub(crate) issued: BTreeMap<u64, Issued<'a>>,
    /// The leases that are out, by calibration, evaluation and whether it is a second one.
    pub(super) live: BTreeMap<(i64, u64, bool), Live>,
    /// Leases that have expired since the last fact of a tick.
    pub(super) expired: Vec<((i64, u64, bool), Live)>,
    /// Workers that have answered in two ways.
    pub(crate) liars: BTreeSet<String>,
    /// Whether second workers verify.
    pub(super) verifies: bool,
    /// The number of leases of an evaluation that expired in a row before they were begun.
    pub(super) unstarted: BTreeMap<(i64, u64), u32>,
    /// Results acknowledged since the last restored backup.
    acknowledged: BTreeSet<(i64, u64)>,
    /// Calibrations that this start of the farm knows.
    begun: BTreeSet<i64>,
    pub(super) lease_ms: u64,
    pub(super) history: u32,
    /// Whether an evaluation was given up after honest failures on three workers. The results then differ from those of the run without
    /// faults.
    pub(crate) is_given_up: bool,
}

impl<'a> Witness<'a> {
    pub(crate) fn new(lease_ms: u64, verifies: bool) -> Self {
        Witness {
            issued: BTreeMap::new(),
            live: BTreeMap::new(),
            expired: Vec::new(),
            liars: BTreeSet::new(),
            verifies,
            unstarted: BTreeMap::new(),
            acknowledged: BTreeSet::new(),
            begun: BTreeSet::new(),
            lease_ms,
            history: 0,
            is_given_up: false,
        }
    }

    /// Returns the numbers of the leases that are out, with their workers.
    pub(crate) fn live(&self) -> impl Iterator<Item = (u64, &str)> {
        self.live.values().map(|live| (live.lease, live.worker.as_str()))
    }

    /// Returns the lease that a result belongs to, if its seal and its worker match.
    pub(super) fn lease_of(&self, result: &WorkResult, worker: &str) -> Option<&Issued<'a>> {
        self.issued.get(&result.lease).filter(|issued| {
            let lease = &issued.lease;
            let same = (lease.calibration, lease.evaluation) == (result.calibration, result.evaluation);
            same && issued.worker == worker && lease.seal == result.seal
        })
    }

    /// Checks a fact before it is in the ledger.
    pub(crate) fn fact(&mut self, fact: &Fact, source: Source, ledger: &Ledger<'a>) -> Result<(), Broken> {
        let id = calibration_of(fact);
        let Some(table) = ledger.table(id) else {
            return Err(Broken::new(
                Promise::Row,
                format!("a fact of calibration {id}, which is not there"),
            ));
        };
        match fact {
            Fact::Evaluated { row, .. } => {
                let by = match source {
                    Source::Exchange(request) if !row.worker.is_empty() => {
                        Some(request.model_version.as_str())
                    }
                    _ => None,
                };
                let pinned = table.model_version.as_deref().map(equations_of);
                demand(by.is_none() || by == pinned, Promise::Version, || {
                    format!(
                        "evaluation {} of calibration {id}, which is pinned to {pinned:?}, is answered by {by:?}",
                        row.evaluation
                    )
                })?;
                self.row(id, table, row)
            }
            Fact::Duplicate {
                evaluation,
                fingerprint,
                ..
            } => {
                let differs = ledger
                    .row(id, *evaluation)
                    .is_some_and(|row| row.fingerprint != *fingerprint);
                let Source::Exchange(request) = source else {
                    return Ok(());
                };
                let is_its_own = |r: &WorkResult| {
                    let issued = self.lease_of(r, &request.worker);
                    let of_it = (r.calibration, r.evaluation) == (id, *evaluation);
                    of_it && issued.is_some_and(|issued| issued.is_of(table))
                };
                demand(
                    !differs || request.results.iter().any(is_its_own),
                    Promise::Dispute,
                    || {
                        format!(
                            "evaluation {evaluation} of calibration {id} is compared with the answer to something else"
                        )
                    },
                )
            }
            Fact::Discovery { .. } | Fact::ValuesExpired { .. } => Ok(()),
            Fact::Confirmed { evaluation, .. } => {
                self.live.remove(&(id, *evaluation, true));
                Ok(())
            }
            Fact::Quarantined { worker, .. } => {
                self.live.retain(|_, live| live.worker != *worker);
                demand(self.liars.contains(worker), Promise::Quarantine, || {
                    format!("{worker}, which is honest, is quarantined")
                })
            }
            Fact::Rewound { .. } | Fact::Repinned { .. } => {
                self.live.retain(|(calibration, ..), _| *calibration != id);
                self.unstarted.retain(|(calibration, _), _| *calibration != id);
                Ok(())
            }
            Fact::Stage { record, .. } => {
                let same = table.case.stages.get(record.stage - 1) == Some(&stage_bits(record));
                demand(same, Promise::Result, || {
                    format!("stage {} of calibration {id} has other bits", record.stage)
                })
            }
            Fact::Posterior { posterior, .. } => {
                let same = table.case.result == CaseResult::Posterior(posterior_bits(posterior));
                demand(same, Promise::Result, || {
                    format!("the posterior of calibration {id} has other bits")
                })
            }
            Fact::Estimate { estimate, .. } => {
                let same = table.case.result == CaseResult::Estimate(format!("{estimate:?}"));
                demand(same, Promise::Result, || {
                    format!("the estimate of calibration {id} has other bits")
                })
            }
            Fact::State { state, message, .. } => self.state(id, table, *state, message.as_deref(), source),
            // Built-in models are not evaluated twice by one worker.
            Fact::Repeated { .. } => Ok(()),
            Fact::ModelVersion { version, .. } => {
                let equations = equations_of(version);
                self.live
                    .retain(|(calibration, ..), live| *calibration != id || live.version == equations);
                let by_result = matches!(source, Source::Exchange(r) if r.model_version == equations && !r.results.is_empty());
                demand(
                    table.model_version.is_none() && by_result,
                    Promise::Version,
                    || {
                        format!(
                            "calibration {id} is pinned to {version} after {:?}",
                            table.model_version
                        )
                    },
                )
            }
            Fact::Fault {
                evaluation,
                attempt,
                worker,
                ..
            } => self.attempt((id, *evaluation), *attempt as usize, worker, table, source),
        }
    }

    fn row(&mut self, id: i64, table: &Table, row: &EvaluationRow) -> Result<(), Broken> {
        let evaluation = row.evaluation;
        demand(!table.rows.contains_key(&evaluation), Promise::Once, || {
            format!("evaluation {evaluation} of calibration {id} gets a second row")
        })?;
        demand(!table.state.is_final(), Promise::Open, || {
            format!(
                "evaluation {evaluation} of calibration {id}, which is {}, gets a row",
                table.state.name()
            )
        })?;
        self.live.remove(&(id, evaluation, false));
        let second = self.live.get(&(id, evaluation, true));
        if second.is_some_and(|live| live.worker == row.worker || row.worker.is_empty() || !self.verifies) {
            self.live.remove(&(id, evaluation, true));
        }
        if row.worker.is_empty() {
            let failed = table.failed.get(&evaluation);
            let workers: BTreeSet<&String> = failed.into_iter().flatten().collect();
            // A user skips faults only where just the poisonous evaluation has failed.
            self.is_given_up = table.case.poison != Some(evaluation);
            return demand(
                !self.is_given_up || workers.len() >= ATTEMPTS,
                Promise::Pause,
                || format!("evaluation {evaluation} is given up after failures on {workers:?}"),
            );
        }
        let same = table
            .case
            .answers
            .get(&evaluation)
            .is_some_and(|a| same_row(&a.row, row));
        demand(same, Promise::Row, || {
            format!("evaluation {evaluation} of calibration {id} has another row")
        })
    }

    fn state(
        &mut self,
        id: i64,
        table: &Table,
        state: CalibrationState,
        message: Option<&str>,
        source: Source,
    ) -> Result<(), Broken> {
        let is_resumed = state == CalibrationState::Running && matches!(source, Source::Command);
        if state.is_final() || is_resumed {
            // Earlier leases are forgotten; after the resumption, the evaluations are leased again.
            self.live.retain(|(calibration, ..), _| *calibration != id);
            self.unstarted.retain(|(calibration, _), _| *calibration != id);
        }
        match state {
            CalibrationState::Finished => table.is_complete(id),
            CalibrationState::Failed => Err(Broken::new(
                Promise::End,
                format!("calibration {id} fails: {}", message.unwrap_or_default()),
            )),
            CalibrationState::Paused => {
                let exhausted = table.failed.values().any(|workers| workers.len() >= ATTEMPTS)
                    || self
                        .unstarted
                        .iter()
                        .any(|((calibration, _), &count)| *calibration == id && count >= UNSTARTED);
                let by_user = matches!(source, Source::Command);
                demand(exhausted || by_user, Promise::Pause, || {
                    format!("calibration {id} pauses after {:?}", table.failed)
                })
            }
            _ => Ok(()),
        }
    }

    fn attempt(
        &mut self,
        (id, evaluation): (i64, u64),
        attempt: usize,
        worker: &str,
        table: &Table,
        source: Source,
    ) -> Result<(), Broken> {
        if attempt == 0 {
            return demand(matches!(source, Source::Command), Promise::Attempt, || {
                format!("evaluation {evaluation} gets new attempts without a user")
            });
        }
        let before = table.failed.get(&evaluation).map_or(0, Vec::len);
        demand(attempt == before + 1, Promise::Attempt, || {
            format!("attempt {attempt} at evaluation {evaluation} follows {before} failed ones")
        })?;
        let is_its_own =
            match source {
                Source::Exchange(request) => {
                    self.live.remove(&(id, evaluation, false));
                    let of_it = |r: &&WorkResult| (r.calibration, r.evaluation) == (id, evaluation);
                    request.worker == worker
                        && request.results.iter().filter(of_it).any(|r| {
                            matches!(r.outcome, Outcome::Fault(_)) && self.lease_of(r, worker).is_some()
                        })
                }
                Source::Tick => self.expired.iter().any(|(calibration, live)| {
                    *calibration == (id, evaluation, false) && live.worker == worker && live.started
                }),
                Source::Command | Source::Restart | Source::Step => false,
            };
        demand(is_its_own, Promise::Attempt, || {
            format!(
                "an attempt at evaluation {evaluation} is charged to {worker}, which had neither begun nor failed"
            )
        })
    }

    /// Notes that results were dropped.
    pub(crate) fn rewound(&mut self, id: i64, ledger: &Ledger) {
        if let Some(table) = ledger.table(id) {
            self.acknowledged.retain(|(calibration, evaluation)| {
                *calibration != id || table.rows.contains_key(evaluation)
            });
        }
    }

    /// Checks that an answer that differs from the row of its evaluation is a dispute.
    pub(super) fn disputed(&self, request: &ExchangeRequest, ledger: &Ledger) -> Result<(), Broken> {
        for result in &request.results {
            let (id, evaluation) = (result.calibration, result.evaluation);
            let Some(table) = ledger.table(id).filter(|_| self.begun.contains(&id)) else {
                continue;
            };
            let row = table
                .rows
                .get(&evaluation)
                .filter(|(_, row)| !row.worker.is_empty());
            let issued = self.lease_of(result, &request.worker);
            let issued = issued.filter(|issued| issued.is_of(table));
            let Some((_, row)) = row else { continue };
            // An honest answer has the bits of the row, whichever worker gave it.
            if issued.is_none_or(|issued| issued.answered.outcome == result.outcome) {
                continue;
            }
            let differs = SimulationResult::new(result.outcome.clone())
                .is_ok_and(|c| c.fingerprint() != row.fingerprint);
            demand(
                // After a rewind, the question under a number of an earlier round is unknown.
                !differs
                    || table.is_rewound
                    || table.disputes.contains(&evaluation)
                    || ledger.quarantine().contains_key(&request.worker),
                Promise::Dispute,
                || {
                    format!(
                        "{} answers evaluation {evaluation} of calibration {id} otherwise, and nobody is told",
                        request.worker
                    )
                },
            )?;
        }
        Ok(())
    }

    /// Checks the answer to a worker's results when it leaves the coordinator.
    pub(crate) fn acknowledged(
        &mut self,
        worker: &str,
        results: &[WorkResult],
        ledger: &Ledger,
    ) -> Result<(), Broken> {
        for result in results {
            let (id, evaluation) = (result.calibration, result.evaluation);
            let issued = self
                .lease_of(result, worker)
                .filter(|issued| issued.history == self.history);
            let is_fault = matches!(result.outcome, Outcome::Fault(_));
            let counts = |table: &&Table| issued.is_some_and(|issued| issued.is_of(table)) && !is_fault;
            let Some(table) = ledger.table(id).filter(counts) else {
                continue;
            };
            let on_disk = table
                .rows
                .get(&evaluation)
                .is_some_and(|(place, _)| *place < ledger.durable());
            let is_cancelled = table.state == CalibrationState::Cancelled;
            let is_refused = ledger.quarantine().contains_key(worker);
            demand(
                on_disk || is_cancelled || is_refused || !table.wrong.is_empty(),
                Promise::Acknowledged,
                || {
                    format!(
                        "the answer to {worker} acknowledges evaluation {evaluation} of calibration {id}, which is not on disk"
                    )
                },
            )?;
            if on_disk {
                self.acknowledged.insert((id, evaluation));
            }
        }
        Ok(())
    }

    /// Notes that a calibration was given to the farm.
    pub(crate) fn began(&mut self, id: i64) {
        self.begun.insert(id);
    }

    /// Checks what a crash has left; `restored` states whether a backup was restored.
    pub(crate) fn crashed(&mut self, ledger: &Ledger, restored: bool) -> Result<(), Broken> {
        self.live.clear();
        self.unstarted.clear();
        self.begun.clear();
        if restored {
            self.history += 1;
            self.acknowledged.clear();
        }
        for (id, evaluation) in &self.acknowledged {
            let stands = ledger
                .table(*id)
                .is_some_and(|table| table.rows.contains_key(evaluation));
            demand(stands, Promise::Acknowledged, || {
                format!(
                    "evaluation {evaluation} of calibration {id} was acknowledged and is gone after a crash"
                )
            })?;
        }
        let finished = ledger
            .tables()
            .iter()
            .filter(|(_, t)| t.state == CalibrationState::Finished);
        finished
            .into_iter()
            .try_for_each(|(&id, table)| table.is_complete(id))
    }
}
