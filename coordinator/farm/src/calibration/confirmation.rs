//! Answers that two workers give: what follows when they agree, and when they do not.

use shared::api::CalibrationState;

use super::faults::NOBODY;
use super::process::Calibration;
use super::second_answer::{Answer, Verdict};
use record::Fact;

impl Calibration {
    /// Lets the answer to an evaluation, which is about to come, be compared with that of a second worker.
    pub fn verify(&mut self, evaluation: u64) {
        if self.verification.is_on() && self.queue.is_asked(evaluation) {
            self.ask_second(evaluation, None);
        }
    }

    /// The answer did not come: nothing is compared so far.
    pub(super) fn forget_verification(&mut self, evaluation: u64) {
        if self.second.is_unanswered(evaluation) {
            self.second.drop(evaluation);
        }
    }

    /// Counts the answer that is stored; its evaluation may be asked for twice.
    pub(super) fn answered_first(&mut self, evaluation: u64, answer: &Answer) {
        if answer.worker == NOBODY {
            self.second.drop(evaluation);
            return;
        }
        if self.verification.selects(evaluation) {
            self.ask_second(evaluation, None);
        }
        *self.unconfirmed.entry(answer.worker.clone()).or_default() += 1;
        self.second.answered(evaluation, answer.clone());
    }

    /// The same of an answer that was stored before a restart. The round of its evaluation is the present one.
    pub(super) fn replay_confirmation(&mut self, evaluation: u64, answer: &Answer, is_confirmed: bool) {
        if is_confirmed {
            self.confirmed += 1;
        } else {
            self.answered_first(evaluation, answer);
        }
    }

    /// Takes an answer to an evaluation that has one already. The facts to store.
    pub(super) fn compare(&mut self, evaluation: u64, answer: Answer) -> Vec<Fact> {
        let (calibration, worker) = (self.identity.id, answer.worker.clone());
        let fingerprint = answer.fingerprint;
        let duplicate = Fact::Duplicate {
            calibration,
            evaluation,
            fingerprint,
            worker: worker.clone(),
        };
        if !self.verification.is_on() {
            return vec![duplicate];
        }
        if !self.second.contains(evaluation)
            && let Some(stored) = self.done.get(&evaluation)
            && stored.answer.worker != NOBODY
        {
            match (stored.answer.fingerprint == fingerprint, stored.is_confirmed) {
                (true, true) => return Vec::new(),
                (false, true) => {
                    self.convicted.push((worker, evaluation));
                    return vec![duplicate];
                }
                (true, false) if stored.answer.worker == worker => return Vec::new(),
                // An answer that nobody asked for confirms as well as one that was, or brings a dispute that others settle.
                (_, false) => {
                    let first = stored.answer.clone();
                    self.ask_second(evaluation, None);
                    self.second.answered(evaluation, first);
                }
            }
        }
        let is_known = self.second.contains(evaluation) || self.done.contains_key(&evaluation);
        match self.second.answered(evaluation, answer) {
            // After a rewind the same number may have asked something else before.
            Verdict::NotAsked if self.is_rewound && !is_known => Vec::new(),
            Verdict::NotAsked | Verdict::Differ => vec![duplicate],
            Verdict::Open => Vec::new(),
            Verdict::Contradiction => {
                self.convicted.push((worker, evaluation));
                vec![duplicate]
            }
            Verdict::Settled { wrong, first } => {
                self.convicted
                    .extend(wrong.iter().map(|name| (name.clone(), evaluation)));
                if wrong.contains(&first) {
                    return vec![duplicate];
                }
                self.confirmed += 1;
                if let Some(stored) = self.done.get_mut(&evaluation) {
                    stored.is_confirmed = true;
                }
                if let Some(count) = self.unconfirmed.get_mut(&first) {
                    *count -= 1;
                }
                vec![Fact::Confirmed {
                    calibration,
                    evaluation,
                    worker,
                }]
            }
        }
    }

    /// The share of the evaluations that a second worker computes as well, of the share that is asked for. A model that is not ours
    /// may answer in two ways on honest machines: it is asked twice on one, and nobody is blamed.
    pub fn verified_share(&self, asked: f64) -> f64 {
        match &self.spec.model.external {
            None => asked,
            Some(_) => 0.0,
        }
    }

    /// Asks nobody beside a lease that is out no more, or one of a suspect, which is alone wherever it is. An evaluation that has
    /// been leased anew is not slow yet.
    pub fn drop_idle_seconds(&mut self) {
        let queue = &self.queue;
        self.second.drop_idle(|evaluation, slow| {
            queue.lease_of(evaluation) == Some(slow) && !queue.is_suspect(evaluation)
        });
    }

    /// The workers found to compute wrongly since the last call, each with the evaluation that shows it.
    pub fn take_convicted(&mut self) -> Vec<(String, u64)> {
        std::mem::take(&mut self.convicted)
    }

    /// Whether answers of a worker are stored that nobody has confirmed.
    pub fn rests_on(&self, worker: &str) -> bool {
        self.unconfirmed.get(worker).is_some_and(|&count| count > 0)
    }

    /// Ends the calibration as soon as no answer waits to be compared.
    pub(super) fn conclude(&mut self, facts: &mut Vec<Fact>) {
        self.is_concluded = true;
        self.settle(facts);
    }

    /// Whether nothing is left but to compare answers.
    pub fn is_concluded(&self) -> bool {
        self.is_concluded && !self.state.is_final()
    }

    /// Ends a calibration that has nothing left to do, not even to compare.
    pub fn settle(&mut self, facts: &mut Vec<Fact>) {
        if self.is_concluded() && self.second.waiting() == 0 {
            self.finish(CalibrationState::Finished, None, facts);
        }
    }
}
