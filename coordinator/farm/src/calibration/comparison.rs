//! The comparison of a calibration's answers with those of a second worker.

use super::Calibration;
use super::second_answer::Answer;
use super::witness::NOBODY;
use record::Fact;

impl Calibration {
    /// Takes the first answer to an evaluation, which is stored, and asks a second worker if the evaluation is to be verified.
    pub(super) fn answered_first(&mut self, answer: Answer, evaluation: u64) {
        self.witness.store(evaluation, answer.clone(), false);
        if answer.worker == NOBODY {
            self.witness.second.drop(evaluation);
            return;
        }
        if self.witness.verification.selects(evaluation) {
            self.ask_second(evaluation, None);
        }
        self.witness.count_unconfirmed(&answer.worker);
        self.witness.second.answered(evaluation, answer);
    }

    /// Takes an answer of the present round that was stored before a restart.
    pub(super) fn answered_before(&mut self, answer: Answer, evaluation: u64, is_confirmed: bool) {
        match is_confirmed {
            true => self.witness.store(evaluation, answer, true),
            false => self.answered_first(answer, evaluation),
        }
    }

    /// Takes a further answer to an evaluation. Returns the facts to store.
    pub(super) fn compare(&mut self, evaluation: u64, answer: Answer) -> Vec<Fact> {
        if let Some(first) = self.witness.disputed(evaluation, &answer) {
            self.ask_second(evaluation, None);
            self.witness.second.answered(evaluation, first);
        }
        self.witness.compare(self.identity.id, evaluation, answer)
    }
}
