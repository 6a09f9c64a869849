//! Failed attempts at evaluations: how often an evaluation is tried, and when it is given up.
//!
//! Three failed attempts on three different workers count as the fault of the evaluation: it is recorded as rejected, with the reason
//! `fault`, and the calibration goes on, for at most [`GIVEN_UP_PERCENT`] of a round. Above that share, and where fewer workers failed, so
//! that a machine may be at fault, the calibration pauses.

use shared::api::CalibrationState;

use super::Calibration;
use super::simulation_result::SimulationResult;
use super::witness::NOBODY;
use crate::lease::{LeaseFailure, MAX_ATTEMPTS, MAX_UNSTARTED};
use record::Fact;

/// The share of a round's evaluations that may be given up, rounded to the nearest whole number, which is zero below 50 evaluations `[%]`.
const GIVEN_UP_PERCENT: usize = 1;

impl Calibration {
    /// Records that a lease failed; attempts are remembered over restarts. When they are used up, the evaluation is given up or the
    /// calibration pauses.
    pub fn lease_failed(&mut self, failure: &LeaseFailure, message: &str) -> Vec<Fact> {
        let evaluation = failure.evaluation;
        self.failed
            .entry(evaluation)
            .or_default()
            .push(failure.worker.clone());
        let mut facts = vec![Fact::Fault {
            calibration: self.identity.id,
            evaluation,
            attempt: failure.attempt,
            worker: failure.worker.clone(),
            message: message.to_owned(),
        }];
        if !failure.exhausted() {
            return facts;
        }
        let theta = self.theta(evaluation).map(<[f64]>::to_vec).unwrap_or_default();
        let what = format!(
            "evaluation {evaluation} at theta = {theta:?} failed on {} attempts, the last on worker {}: {message}",
            failure.attempt, failure.worker
        );
        let max_given_up = (GIVEN_UP_PERCENT * self.queue.len() + 50) / 100;
        if failure.is_evaluations_own() && self.witness.given_up() < max_given_up {
            tracing::warn!(
                calibration = self.identity.id,
                what,
                "given up: it counts as rejected"
            );
            self.give_up(evaluation, message, &mut facts);
        } else {
            let help = "resume tries it again; resume --skip-faults counts it as rejected";
            self.change_state(
                CalibrationState::Paused,
                Some(format!("{what}; {help}")),
                &mut facts,
            );
        }
        facts
    }

    /// Pauses because no worker has begun an evaluation in many leases. It is unknown whether the evaluation or a machine is at fault.
    pub fn never_begun(&mut self, evaluation: u64) -> Vec<Fact> {
        if !self.is_open() {
            return Vec::new();
        }
        let theta = self.theta(evaluation).map(<[f64]>::to_vec).unwrap_or_default();
        let message = format!(
            "evaluation {evaluation} at theta = {theta:?} was leased {MAX_UNSTARTED} times in a row, and each worker was lost before it reported that it began; resume tries it again"
        );
        let mut facts = Vec::new();
        self.change_state(CalibrationState::Paused, Some(message), &mut facts);
        facts
    }

    /// Resumes after a pause. Evaluations without attempts left are given up with `skip_faults`; otherwise they get new attempts.
    pub fn resume(&mut self, skip_faults: bool, facts: &mut Vec<Fact>) {
        let failed = std::mem::take(&mut self.failed);
        let exhausted = failed
            .iter()
            .filter(|(evaluation, workers)| {
                let is_open = !self.witness.is_answered(**evaluation) && self.theta(**evaluation).is_some();
                skip_faults && is_open && workers.len() >= MAX_ATTEMPTS as usize
            })
            .map(|(&evaluation, _)| evaluation)
            .collect::<Vec<u64>>();
        // Attempt 0 in the list of faults makes the new attempts outlive a restart.
        facts.extend(failed.into_keys().map(|evaluation| Fact::Fault {
            calibration: self.identity.id,
            evaluation,
            attempt: 0,
            worker: NOBODY.into(),
            message: "given new attempts by a user".into(),
        }));
        self.fill_queue();
        self.witness.second.drop_idle(|_, _| false);
        for evaluation in self.witness.answered_evaluations() {
            self.queue.complete(evaluation);
        }
        self.change_state(CalibrationState::Running, None, facts);
        for evaluation in exhausted {
            self.give_up(evaluation, "skipped by a user after failed attempts", facts);
        }
    }

    /// Records an evaluation as rejected because of faults.
    fn give_up(&mut self, evaluation: u64, message: &str, facts: &mut Vec<Fact>) {
        let given_up = SimulationResult::refused(format!("fault: given up: {message}"));
        match self.complete(evaluation, given_up, NOBODY) {
            Ok((more, _)) => facts.extend(more),
            Err(error) => self.change_state(CalibrationState::Paused, Some(error.to_string()), facts),
        }
    }
}
