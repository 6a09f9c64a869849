//! The comparison of a calibration's answers with those of a second worker.

use super::Calibration;
use super::second_answer::{Answer, Undecided};
use super::witness::NOBODY;
use record::Fact;

impl Calibration {
    /// Takes the first answer to an evaluation, which is stored, and asks a second worker if the evaluation is to be verified.
    pub(super) fn answered_first(&mut self, answer: Answer, evaluation: u64) {
        self.witness.store(evaluation, answer.clone(), None);
        if answer.worker == NOBODY {
            self.witness.second.drop(evaluation);
            return;
        }
        if self.witness.verifies(evaluation, &answer.worker) {
            self.ask_second(evaluation, None);
        }
        let voting = &self.witness.verification.rule.voting;
        self.witness.second.answered(evaluation, answer, voting);
    }

    /// Takes an answer of the present round that was stored before a restart, with the worker that had confirmed it.
    pub(super) fn answered_before(&mut self, answer: Answer, evaluation: u64, confirmed_by: Option<&String>) {
        match confirmed_by {
            Some(worker) => self.witness.store(evaluation, answer, Some(worker.clone())),
            None => self.answered_first(answer, evaluation),
        }
    }

    /// Takes a further answer to an evaluation. Returns the facts to store.
    pub(super) fn compare(&mut self, evaluation: u64, answer: Answer) -> Vec<Fact> {
        let stored = self.witness.disputed(evaluation, &answer);
        if !stored.is_empty() {
            self.ask_second(evaluation, None);
            let voting = self.witness.verification.rule.voting.clone();
            for stored in stored {
                self.witness.second.answered(evaluation, stored, &voting);
            }
        }
        self.witness.compare(self.identity.id, evaluation, answer)
    }

    /// Settles the comparisons that no further answer can change. Returns the facts to store.
    ///
    /// `undecided` returns the workers that may still answer an evaluation with some answers.
    pub fn settle(&mut self, undecided: impl Fn(u64, &[Answer]) -> Undecided) -> Vec<Fact> {
        self.witness.settle(self.identity.id, undecided)
    }
}
