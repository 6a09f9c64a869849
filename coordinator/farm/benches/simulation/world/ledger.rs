//! The simulated store: facts in order, of which a prefix is on disk, and the tables that follow from them.
//!
//! Tables follow from facts as in the store's `facts.rs` and `recovery.rs`. A crash cuts facts that are not on disk, and a restored backup
//! cuts facts that are on disk, too.

use std::collections::{BTreeMap, BTreeSet};

use record::{EvaluationKey, EvaluationRow, Fact, Kept, PREDICTIONS_FROM, Quarantine, SealKey, Stored};
use shared::api::CalibrationState;

use super::case::{Case, CaseResult, posterior_bits};
use super::promise::{Broken, Promise, demand};

/// An entry of the ledger.
#[derive(Debug)]
pub(crate) enum Entry<'a> {
    /// A user's new calibration.
    Submitted { id: i64, case: &'a Case, key: SealKey },
    /// A fact of the farm.
    Fact(Fact),
}

/// The stored state of one calibration.
#[derive(Debug)]
pub(crate) struct Table<'a> {
    pub(crate) case: &'a Case,
    pub(crate) key: SealKey,
    pub(crate) state: CalibrationState,
    pub(crate) message: Option<String>,
    pub(crate) model_version: Option<String>,
    pub(crate) busy_ms: u64,
    /// The rows, each with its index among the facts.
    pub(crate) rows: BTreeMap<u64, (usize, EvaluationRow)>,
    /// The workers of failed attempts since a user granted new ones, by evaluation.
    pub(crate) failed: BTreeMap<u64, Vec<String>>,
    pub(crate) disputes: BTreeSet<u64>,
    /// Evaluations that a second worker has confirmed, with that worker.
    pub(crate) confirmed: BTreeMap<u64, String>,
    /// Whether rows were dropped because their worker computes wrongly. Their results are acknowledged, and are computed again.
    pub(crate) is_rewound: bool,
    /// Workers that computed or confirmed rows and compute wrongly. Results that arrive during the replay are acknowledged, and are
    /// computed again.
    pub(crate) wrong: BTreeSet<String>,
    /// The number of stored stages.
    pub(crate) stages: usize,
    pub(crate) result: Option<CaseResult>,
}

/// The facts in order and the tables that follow from them.
#[derive(Debug, Default)]
pub(crate) struct Ledger<'a> {
    entries: Vec<Entry<'a>>,
    /// The number of entries that are on disk.
    durable: usize,
    tables: BTreeMap<i64, Table<'a>>,
    /// Workers that compute wrongly.
    quarantine: BTreeMap<String, Quarantine>,
}

impl<'a> Table<'a> {
    fn new(case: &'a Case, key: SealKey) -> Self {
        Table {
            case,
            key,
            state: CalibrationState::Queued,
            message: None,
            model_version: None,
            busy_ms: 0,
            rows: BTreeMap::new(),
            failed: BTreeMap::new(),
            disputes: BTreeSet::new(),
            confirmed: BTreeMap::new(),
            is_rewound: false,
            wrong: BTreeSet::new(),
            stages: 0,
            result: None,
        }
    }

    /// Applies the fact at an index.
    fn apply(&mut self, fact: &Fact, place: usize) {
        match fact {
            Fact::Evaluated { row, .. } => {
                self.rows
                    .entry(row.evaluation)
                    .or_insert_with(|| (place, row.clone()));
            }
            Fact::Duplicate {
                evaluation,
                fingerprint,
                ..
            } => {
                let differs = |(_, row): &&(usize, EvaluationRow)| {
                    row.fingerprint != *fingerprint && !row.worker.is_empty()
                };
                if self.rows.get(evaluation).filter(differs).is_some() {
                    self.disputes.insert(*evaluation);
                }
            }
            Fact::Stage { record, busy_ms, .. } => {
                self.stages = self.stages.max(record.stage);
                self.busy_ms = *busy_ms;
            }
            Fact::Posterior { posterior, .. } => {
                self.result = Some(CaseResult::Posterior(posterior_bits(posterior)));
            }
            Fact::Estimate { estimate, .. } => {
                self.result = Some(CaseResult::Estimate(format!("{estimate:?}")));
            }
            Fact::Confirmed {
                evaluation, worker, ..
            } => {
                self.confirmed.insert(*evaluation, worker.clone());
            }
            Fact::Rewound { worker, width, .. } => self.rewind(worker, *width as u64),
            Fact::Discovery { .. } | Fact::Quarantined { .. } | Fact::ValuesExpired { .. } => {}
            Fact::State {
                state,
                message,
                busy_ms,
                ..
            } => {
                self.state = *state;
                self.message.clone_from(message);
                self.busy_ms = *busy_ms;
            }
            // Built-in models are not evaluated twice by one worker.
            Fact::Repeated { .. } => {}
            Fact::ModelVersion { version, .. } => self.model_version = Some(version.clone()),
            Fact::Repinned { version, .. } => {
                self.rows.clear();
                self.model_version = Some(version.clone());
            }
            Fact::Fault {
                evaluation,
                attempt: 0,
                ..
            } => {
                self.failed.remove(evaluation);
            }
            Fact::Fault {
                evaluation, worker, ..
            } => self.failed.entry(*evaluation).or_default().push(worker.clone()),
        }
    }

    /// Withdraws the confirmations of a worker that computes wrongly, and drops the rows that rest on such workers alone, with all later
    /// rounds.
    fn rewind(&mut self, worker: &str, width: u64) {
        self.wrong.insert(worker.to_owned());
        // The workers of a token are convicted together, under a name that ends with a slash.
        let includes = |name: &String, worker: &str| {
            name == worker || (name.ends_with('/') && worker.starts_with(name.as_str()))
        };
        let is_wrong = |worker: &str| self.wrong.iter().any(|name| includes(name, worker));
        self.confirmed.retain(|_, by| !is_wrong(by));
        let rests =
            |row: &EvaluationRow| is_wrong(&row.worker) && !self.confirmed.contains_key(&row.evaluation);
        (self.stages, self.result) = (0, None);
        let Some((_, first)) = self.rows.values().find(|(_, row)| rests(row)) else {
            return;
        };
        let end = EvaluationKey::round_end(first.evaluation, width as usize);
        let dropped: Vec<u64> = self
            .rows
            .iter()
            .filter(|(evaluation, (_, row))| **evaluation >= end || rests(row))
            .map(|(&evaluation, _)| evaluation)
            .collect();
        for evaluation in dropped {
            self.rows.remove(&evaluation);
            self.confirmed.remove(&evaluation);
        }
        self.is_rewound = true;
    }

    /// Checks that a finished calibration has all its rows, its stages and its result.
    pub(crate) fn is_complete(&self, id: i64) -> Result<(), Broken> {
        let case = self.case;
        let rows = self.rows.len() == case.answers.len();
        let is_whole = rows && self.stages == case.stages.len() && self.result.as_ref() == Some(&case.result);
        demand(is_whole, Promise::Complete, || {
            format!(
                "calibration {id} is finished with {} of {} rows and {} of {} stages",
                self.rows.len(),
                case.answers.len(),
                self.stages,
                case.stages.len()
            )
        })
    }

    /// Returns what a restart reads.
    pub(crate) fn stored(&self) -> Stored {
        let told_values = self.case.spec.algorithm.is_told_values();
        let evaluation = |row: &EvaluationRow| EvaluationRow {
            kept: match &row.kept {
                Kept::Fitted(_) if !told_values => Kept::Scored,
                Kept::Whole(_) if !told_values || row.evaluation >= PREDICTIONS_FROM => Kept::Scored,
                kept => kept.clone(),
            },
            ..row.clone()
        };
        let evaluations = self.rows.iter();
        Stored {
            state: Some(self.state),
            message: self.message.clone(),
            model_version: self.model_version.clone(),
            busy_ms: self.busy_ms,
            is_rewound: self.is_rewound,
            is_doubted: !self.wrong.is_empty(),
            evaluations: evaluations
                .map(|(&number, (_, row))| (number, evaluation(row)))
                .collect(),
            confirmed: self.confirmed.clone(),
            failed: self.failed.clone(),
        }
    }
}

/// Returns the calibration that a fact is about.
pub(crate) fn calibration_of(fact: &Fact) -> i64 {
    match fact {
        Fact::Evaluated { calibration, .. }
        | Fact::Duplicate { calibration, .. }
        | Fact::Stage { calibration, .. }
        | Fact::Posterior { calibration, .. }
        | Fact::Estimate { calibration, .. }
        | Fact::Discovery { calibration, .. }
        | Fact::State { calibration, .. }
        | Fact::ModelVersion { calibration, .. }
        | Fact::Repinned { calibration, .. }
        | Fact::ValuesExpired { calibration, .. }
        | Fact::Repeated { calibration, .. }
        | Fact::Confirmed { calibration, .. }
        | Fact::Quarantined { calibration, .. }
        | Fact::Rewound { calibration, .. }
        | Fact::Fault { calibration, .. } => *calibration,
    }
}

impl<'a> Ledger<'a> {
    /// Appends an entry that is not yet on disk.
    pub(crate) fn push(&mut self, entry: Entry<'a>) {
        self.entries.push(entry);
        self.apply(self.entries.len() - 1);
    }

    fn apply(&mut self, place: usize) {
        match &self.entries[place] {
            Entry::Submitted { id, case, key } => {
                self.tables.insert(*id, Table::new(case, *key));
            }
            Entry::Fact(fact) => {
                if let Fact::Quarantined {
                    worker,
                    calibration,
                    evaluation,
                } = fact
                {
                    let quarantine = Quarantine {
                        worker: worker.clone(),
                        calibration: *calibration,
                        evaluation: *evaluation,
                    };
                    self.quarantine.insert(worker.clone(), quarantine);
                }
                if let Some(table) = self.tables.get_mut(&calibration_of(fact)) {
                    table.apply(fact, place);
                }
            }
        }
    }

    /// Returns the number of entries.
    pub(crate) fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns the number of entries on disk.
    pub(crate) fn durable(&self) -> usize {
        self.durable
    }

    /// Brings more entries to disk.
    pub(crate) fn commit(&mut self, entries: usize) {
        self.durable = self.durable.saturating_add(entries).min(self.entries.len());
    }

    /// Cuts all entries from an index on, as a crash or a restored backup does.
    pub(crate) fn cut(&mut self, place: usize) {
        self.entries.truncate(place);
        self.durable = self.entries.len();
        self.tables.clear();
        self.quarantine.clear();
        for place in 0..self.entries.len() {
            self.apply(place);
        }
    }

    /// Loses one entry and brings the others to disk, which a store must never do.
    pub(crate) fn lose(&mut self, place: usize) {
        self.entries.remove(place);
        self.durable = self.entries.len();
    }

    /// Returns the tables of all calibrations, on disk or not.
    pub(crate) fn tables(&self) -> &BTreeMap<i64, Table<'a>> {
        &self.tables
    }

    /// Returns the workers that compute wrongly.
    pub(crate) fn quarantine(&self) -> &BTreeMap<String, Quarantine> {
        &self.quarantine
    }

    /// Returns the table of a calibration.
    pub(crate) fn table(&self, id: i64) -> Option<&Table<'a>> {
        self.tables.get(&id)
    }

    /// Returns the row of an evaluation.
    pub(crate) fn row(&self, id: i64, evaluation: u64) -> Option<&EvaluationRow> {
        self.tables.get(&id)?.rows.get(&evaluation).map(|(_, row)| row)
    }
}
