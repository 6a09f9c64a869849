//! The record of answers by worker: whose answers agree, and which workers compute wrongly.

use std::collections::BTreeMap;

use record::Fact;

use super::second_answer::{Answer, SecondAnswers, Undecided, Verdict};
use super::verification::Verification;

/// The worker of an evaluation that was given up.
pub(super) const NOBODY: &str = "";

/// The record of answers by worker.
#[derive(Debug, Default)]
pub struct Witness {
    /// The choice of evaluations that a second worker computes as well.
    pub verification: Verification,
    /// Evaluations that a second worker is asked for.
    pub second: SecondAnswers,
    /// Whether results were dropped, so that numbers of evaluations stood for other questions before.
    pub is_rewound: bool,
    /// Whether a worker that computed or confirmed results of this calibration computes wrongly. Then everything is verified.
    pub is_doubted: bool,
    /// The stored answers of the present round.
    round: BTreeMap<u64, StoredAnswer>,
    /// The number of stored answers, by worker and by the worker that has confirmed them, [`NOBODY`] where none has.
    stored: BTreeMap<String, BTreeMap<String, u64>>,
    /// Workers found to compute wrongly since the last call of [`Witness::take_convicted`], each with the evaluation that shows it.
    convicted: Vec<(String, u64)>,
}

/// A stored answer.
#[derive(Debug, Clone, PartialEq, Eq)]
struct StoredAnswer {
    answer: Answer,
    /// The worker that has given the same answer.
    confirmed_by: Option<String>,
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

    /// Returns whether another worker is asked for an evaluation that a worker has answered. An answer of a trusted worker settles it.
    pub(super) fn verifies(&self, evaluation: u64, worker: &str) -> bool {
        let is_chosen = self.verification.is_on() && self.is_doubted || self.verification.selects(evaluation);
        is_chosen && !self.verification.rule.voting.trusts(worker)
    }

    /// Records the stored answer of an evaluation, and who has confirmed it.
    pub(super) fn store(&mut self, evaluation: u64, answer: Answer, confirmed_by: Option<String>) {
        if answer.worker != NOBODY {
            let by = confirmed_by.as_deref().unwrap_or(NOBODY);
            *self.count(&answer.worker, by) += 1;
        }
        let stored = StoredAnswer { answer, confirmed_by };
        self.round.insert(evaluation, stored);
    }

    /// Returns the number of stored answers of a worker that another one has confirmed.
    fn count(&mut self, worker: &str, confirmed_by: &str) -> &mut u64 {
        if !self.stored.contains_key(worker) {
            self.stored.insert(worker.to_owned(), BTreeMap::new());
        }
        let of_worker = self.stored.get_mut(worker).expect("it has just been inserted");
        if !of_worker.contains_key(confirmed_by) {
            of_worker.insert(confirmed_by.to_owned(), 0);
        }
        of_worker
            .get_mut(confirmed_by)
            .expect("it has just been inserted")
    }

    /// Takes an answer that was not asked for. Returns the stored answers of the present round that it is to be compared with: if it
    /// confirms the stored answer, or if other workers have to settle which is right.
    pub(super) fn disputed(&self, evaluation: u64, answer: &Answer) -> Vec<Answer> {
        let stored = self.round.get(&evaluation);
        let Some(stored) = stored.filter(|stored| stored.answer.worker != NOBODY && stored.answer != *answer)
        else {
            return Vec::new();
        };
        let is_same = stored.answer.fingerprint == answer.fingerprint;
        let is_settled = is_same && stored.confirmed_by.is_some();
        if !self.verification.is_on() || is_settled || self.second.contains(evaluation) {
            return Vec::new();
        }
        let confirmed = stored.confirmed_by.iter().map(|worker| Answer {
            worker: worker.clone(),
            fingerprint: stored.answer.fingerprint,
        });
        std::iter::once(stored.answer.clone()).chain(confirmed).collect()
    }

    /// Takes a further answer to an evaluation. Returns the facts to store.
    pub(super) fn compare(&mut self, calibration: i64, evaluation: u64, answer: Answer) -> Vec<Fact> {
        let worker = answer.worker.clone();
        let duplicate = Fact::Duplicate {
            calibration,
            evaluation,
            fingerprint: answer.fingerprint,
            worker: worker.clone(),
        };
        if !self.verification.is_on() {
            return vec![duplicate];
        }
        let is_repeated = self.second.contains(evaluation);
        let stored = self.round.get(&evaluation).map(|stored| &stored.answer);
        if let Some(stored) = stored.filter(|stored| !is_repeated && stored.worker != NOBODY)
            && stored.fingerprint == answer.fingerprint
        {
            return Vec::new();
        }
        let is_known = is_repeated || self.is_answered(evaluation);
        let voting = &self.verification.rule.voting;
        match self.second.answered(evaluation, answer, voting) {
            // After a rewind, the number may have stood for another question before.
            Verdict::NotAsked if self.is_rewound && !is_known => Vec::new(),
            Verdict::NotAsked | Verdict::Differ => vec![duplicate],
            Verdict::Open => Vec::new(),
            Verdict::Contradiction => {
                self.convicted.push((worker, evaluation));
                vec![duplicate]
            }
        }
    }

    /// Settles comparisons. Returns the facts to store.
    ///
    /// `undecided` returns the workers that may still answer an evaluation with some answers.
    pub(super) fn settle(
        &mut self,
        calibration: i64,
        undecided: impl Fn(u64, &[Answer]) -> Undecided,
    ) -> Vec<Fact> {
        let mut facts = Vec::new();
        let voting = self.verification.rule.voting.clone();
        for settled in self.second.settle(&voting, undecided) {
            let evaluation = settled.evaluation;
            let wrong = settled.wrong.into_iter();
            self.convicted.extend(wrong.map(|worker| (worker, evaluation)));
            if let (Some(first), Some(worker)) = (settled.first, settled.confirmed_by)
                && self.confirm(evaluation, &first, &worker)
            {
                facts.push(Fact::Confirmed {
                    calibration,
                    evaluation,
                    worker,
                });
            }
        }
        facts
    }

    /// Records that another worker has given the same answer as the first one. Returns whether it is the first to do so.
    fn confirm(&mut self, evaluation: u64, first: &str, by: &str) -> bool {
        if let Some(stored) = self.round.get_mut(&evaluation) {
            if stored.confirmed_by.is_some() {
                return false;
            }
            stored.confirmed_by = Some(by.to_owned());
        }
        let unconfirmed = self.count(first, NOBODY);
        let is_first = *unconfirmed > 0;
        *unconfirmed -= u64::from(is_first);
        *self.count(first, by) += u64::from(is_first);
        is_first
    }

    /// Returns the workers found to compute wrongly since the last call, each with the evaluation that shows it.
    pub fn take_convicted(&mut self) -> Vec<(String, u64)> {
        std::mem::take(&mut self.convicted)
    }

    /// Returns whether workers that satisfy a condition have computed or confirmed stored answers.
    pub fn involves(&self, is_one: impl Fn(&str) -> bool) -> bool {
        self.stored.iter().any(|(worker, by)| {
            let mut by = by.iter().filter(|(_, count)| **count > 0);
            by.any(|(confirmed_by, _)| is_one(worker) || is_one(confirmed_by))
        })
    }
}
