//! The record of answers by worker: whose answers agree, and which workers compute wrongly.

use std::collections::BTreeMap;

use record::Fact;

use super::second_answer::{Answer, SecondAnswers, Verdict};
use super::verification::Verification;

/// The worker of an evaluation that was given up.
pub(super) const NOBODY: &str = "";

/// The record of answers by worker.
#[derive(Debug)]
pub struct Witness {
    /// The choice of evaluations that a second worker computes as well.
    pub verification: Verification,
    /// Evaluations that a second worker is asked for.
    pub second: SecondAnswers,
    /// Whether results were dropped, so that numbers of evaluations stood for other questions before.
    pub is_rewound: bool,
    /// The stored answers of the present round.
    round: BTreeMap<u64, StoredAnswer>,
    /// The number of unconfirmed stored answers, by worker.
    unconfirmed: BTreeMap<String, u64>,
    /// Workers found to compute wrongly since the last call of [`Witness::take_convicted`], each with the evaluation that shows it.
    convicted: Vec<(String, u64)>,
}

/// A stored answer.
#[derive(Debug, Clone, PartialEq, Eq)]
struct StoredAnswer {
    answer: Answer,
    /// Whether another worker has given the same answer.
    is_confirmed: bool,
}

impl Default for Witness {
    fn default() -> Self {
        Witness {
            verification: Verification::OFF,
            second: SecondAnswers::default(),
            is_rewound: false,
            round: BTreeMap::new(),
            unconfirmed: BTreeMap::new(),
            convicted: Vec::new(),
        }
    }
}

impl Witness {
    /// Forgets the answers of the previous round.
    pub(super) fn begin_round(&mut self) {
        self.round.clear();
    }

    /// Returns the number of evaluations of the present round that are answered.
    pub(super) fn answered(&self) -> usize {
        self.round.len()
    }

    /// Returns the number of evaluations of the present round that were given up after faults.
    pub(super) fn given_up(&self) -> usize {
        let answers = self.round.values();
        answers.filter(|stored| stored.answer.worker == NOBODY).count()
    }

    /// Returns whether an evaluation of the present round is answered.
    pub(super) fn is_answered(&self, evaluation: u64) -> bool {
        self.round.contains_key(&evaluation)
    }

    /// Returns the answered evaluations of the present round.
    pub(super) fn answered_evaluations(&self) -> Vec<u64> {
        self.round.keys().copied().collect()
    }

    /// Records the stored answer of an evaluation.
    pub(super) fn store(&mut self, evaluation: u64, answer: Answer, is_confirmed: bool) {
        let stored = StoredAnswer { answer, is_confirmed };
        self.round.insert(evaluation, stored);
    }

    /// Returns the stored answer that an unrequested answer should be compared with. The comparison confirms the stored answer, or starts a
    /// dispute that other workers settle.
    pub(super) fn disputed(&self, evaluation: u64, answer: &Answer) -> Option<Answer> {
        let stored = self.round.get(&evaluation).map(|stored| &stored.answer);
        let stored = stored.filter(|stored| stored.worker != NOBODY && *stored != answer)?;
        let is_open = !self.second.contains(evaluation) && !self.round[&evaluation].is_confirmed;
        (self.verification.is_on() && is_open).then(|| stored.clone())
    }

    /// Takes a further answer to an evaluation. Returns the facts to store.
    pub(super) fn compare(&mut self, calibration: i64, evaluation: u64, answer: Answer) -> Vec<Fact> {
        let (worker, fingerprint) = (answer.worker.clone(), answer.fingerprint);
        let duplicate = Fact::Duplicate {
            calibration,
            evaluation,
            fingerprint,
            worker: worker.clone(),
        };
        if !self.verification.is_on() {
            return vec![duplicate];
        }
        let is_repeated = self.second.contains(evaluation);
        if let Some(stored) = self.round.get(&evaluation).filter(|_| !is_repeated)
            && stored.answer.worker != NOBODY
        {
            let is_same = stored.answer.fingerprint == fingerprint;
            if is_same && (stored.is_confirmed || stored.answer.worker == worker) {
                return Vec::new();
            }
            if stored.is_confirmed {
                self.convicted.push((worker, evaluation));
                return vec![duplicate];
            }
        }
        let is_known = is_repeated || self.is_answered(evaluation);
        match self.second.answered(evaluation, answer) {
            // After a rewind, the number may have stood for another question before.
            Verdict::NotAsked if self.is_rewound && !is_known => Vec::new(),
            Verdict::NotAsked | Verdict::Differ => vec![duplicate],
            Verdict::Open => Vec::new(),
            Verdict::Contradiction => {
                self.convicted.push((worker, evaluation));
                vec![duplicate]
            }
            Verdict::Agreed { wrong, first } => {
                let convicted = wrong.iter().map(|name| (name.clone(), evaluation));
                self.convicted.extend(convicted);
                if wrong.contains(&first) {
                    return vec![duplicate];
                }
                self.confirm(evaluation, &first);
                vec![Fact::Confirmed {
                    calibration,
                    evaluation,
                    worker,
                }]
            }
        }
    }

    /// Counts an unconfirmed answer of a worker.
    pub(super) fn count_unconfirmed(&mut self, worker: &str) {
        *self.unconfirmed.entry(worker.to_owned()).or_default() += 1;
    }

    /// Records that another worker has given the same answer as the first one.
    fn confirm(&mut self, evaluation: u64, first: &str) {
        if let Some(stored) = self.round.get_mut(&evaluation) {
            stored.is_confirmed = true;
        }
        if let Some(count) = self.unconfirmed.get_mut(first) {
            *count -= 1;
        }
    }

    /// Returns the workers found to compute wrongly since the last call, each with the evaluation that shows it.
    pub fn take_convicted(&mut self) -> Vec<(String, u64)> {
        std::mem::take(&mut self.convicted)
    }

    /// Returns whether a worker has unconfirmed stored answers.
    pub fn rests_on(&self, worker: &str) -> bool {
        self.unconfirmed.get(worker).is_some_and(|&count| count > 0)
    }
}
