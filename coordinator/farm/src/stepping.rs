//! The steps of engines, which the farm hands out and is told of.

use super::farm::Farm;
use super::replay_cause::ReplayCause;
use crate::calibration::{Step, Stepped};
use shared::api::CalibrationState;

impl Farm {
    /// Returns the steps that have become due since the last call.
    pub fn take_steps(&mut self) -> Vec<Step> {
        let mut steps = Vec::new();
        // What waits for its replay is replaced.
        for entry in self.calibrations.values_mut().filter(|e| e.rewinds == 0) {
            let number = self.last_step + 1;
            if let Some(step) = entry.calibration.take_step(number) {
                self.last_step = number;
                steps.push(step);
            }
        }
        steps
    }

    /// Returns whether a calibration waits for the step of a number: it is not over, and has not been replayed since.
    pub fn awaits_step(&self, id: i64, number: u64) -> bool {
        self.calibrations
            .get(&id)
            .is_some_and(|entry| entry.rewinds == 0 && entry.calibration.awaits_step(number))
    }

    /// Goes on with a calibration whose step has been taken. One that is over, or waits for its replay, or has been replayed, needs the
    /// step no more.
    pub fn stepped(&mut self, stepped: Stepped, now_ms: u64) {
        let id = stepped.calibration;
        let Some(entry) = self.calibrations.get_mut(&id).filter(|e| e.rewinds == 0) else {
            return;
        };
        let facts = entry.calibration.stepped(stepped);
        self.keep(facts);
        self.settle(id, now_ms);
        self.finish_if_compared(id, now_ms);
        self.account(now_ms);
    }

    /// Pauses a calibration whose step has ended in an error of the program. A user who resumes it starts a replay, which takes the step
    /// again.
    pub fn step_failed(&mut self, id: i64, number: u64, reason: &str) {
        let Some(entry) = self.calibrations.get_mut(&id) else {
            return;
        };
        if entry.rewinds > 0 || !entry.calibration.awaits_step(number) {
            return;
        }
        entry.rewinds += 1;
        entry.is_replay_due = true;
        entry.replay_cause = ReplayCause::Step;
        let message = format!("the next round cannot be proposed, by an error of the program: {reason}");
        let paused = CalibrationState::Paused;
        entry
            .calibration
            .change_state(paused, Some(message), &mut self.facts);
    }
}
