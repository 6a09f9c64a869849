//! A calibration between two rounds: its step is due, is being taken, and has been taken.

use inference::TellProgress;
use record::{EvaluationRow, Fact};
use shared::api::CalibrationState;

use super::Calibration;
use super::engine::CalibrationEngine;
use super::step::{DueStep, Step, Stepped};

impl Calibration {
    /// Ends the round with its last result: the step is due, and its engine takes no more results. Questions of the round are no longer
    /// known.
    pub(super) fn end_round(&mut self, particle: usize, row: &EvaluationRow, values: Option<Vec<f64>>) {
        let outline = CalibrationEngine::Stepping(Box::new(self.engine.outline()));
        let step = Step {
            calibration: self.identity.id,
            number: 0,
            engine: std::mem::replace(&mut self.engine, outline),
            particle,
            row: row.clone(),
            values,
            answers: self.queue.len(),
            busy_ms: self.cost.busy_ms,
            has_histories: self.variants.has_histories(),
        };
        self.witness.begin_round();
        self.due = Some(DueStep::Waiting(Box::new(step)));
    }

    /// Returns whether a step is due or being taken.
    pub fn is_stepping(&self) -> bool {
        self.due.is_some()
    }

    /// Takes the step that is due out of the calibration, under a number by which [`Calibration::stepped`] knows it again.
    pub fn take_step(&mut self, number: u64) -> Option<Step> {
        match self.due.take() {
            Some(DueStep::Waiting(step)) => {
                self.due = Some(DueStep::Taken(number));
                Some(Step { number, ..*step })
            }
            taken => {
                self.due = taken;
                None
            }
        }
    }

    /// Returns whether the step of a number has left the calibration and not come back.
    pub fn awaits_step(&self, number: u64) -> bool {
        matches!(self.due, Some(DueStep::Taken(awaited)) if awaited == number)
    }

    /// Takes the step that is due on the thread of the caller. Returns the facts to store.
    pub fn step(&mut self) -> Vec<Fact> {
        match self.take_step(0) {
            Some(step) => self.stepped(step.run()),
            None => Vec::new(),
        }
    }

    /// Goes on with what a step has computed; a step that the calibration does not wait for changes nothing. Returns the facts to store.
    pub fn stepped(&mut self, stepped: Stepped) -> Vec<Fact> {
        if !self.awaits_step(stepped.number) {
            return Vec::new();
        }
        self.due = None;
        self.engine = stepped.engine;
        let mut facts = stepped.facts;
        match stepped.progress {
            Ok(TellProgress::Waiting) => {}
            Ok(TellProgress::NextRound | TellProgress::StageFinished) => self.ask(),
            Ok(TellProgress::Finished) => self.end_sampling(stepped.draws, &mut facts),
            Ok(TellProgress::Failed(failure)) => {
                self.finish(CalibrationState::Failed, Some(failure.to_string()), &mut facts);
            }
            Err(error) => self.finish(CalibrationState::Failed, Some(error.to_string()), &mut facts),
        }
        facts
    }
}
