//! A step of an engine: what it computes once the last result of a round has come.
//!
//! A step of a large population or of a search takes seconds of CPU time, so the farm's thread does not take it: the engine is moved into
//! a [`Step`], which is pure and runs on any thread, and comes back in a [`Stepped`]. Meanwhile the calibration takes late results and
//! commands, and asks for nothing.

use inference::TellProgress;
use record::{EvaluationRow, Fact};

use super::engine::{CalibrationEngine, CalibrationResult, EngineError};
use super::final_draws::FinalDraws;

/// A step that is due, with all that it needs.
#[derive(Debug)]
pub struct Step {
    pub(super) calibration: i64,
    pub(super) number: u64,
    pub(super) engine: CalibrationEngine,
    /// The particle of the last result of the round.
    pub(super) particle: usize,
    pub(super) row: EvaluationRow,
    pub(super) values: Option<Vec<f64>>,
    /// The number of the round's results.
    pub(super) answers: usize,
    pub(super) busy_ms: u64,
    pub(super) has_histories: bool,
}

/// A step that has been taken.
#[derive(Debug)]
pub struct Stepped {
    pub(crate) calibration: i64,
    pub(super) number: u64,
    pub(super) engine: CalibrationEngine,
    pub(super) progress: Result<TellProgress, EngineError>,
    /// The stages and the result that the step has ended.
    pub(super) facts: Vec<Fact>,
    /// The draws to simulate, if the step has ended the engine.
    pub(super) draws: Option<FinalDraws>,
}

/// The step of a calibration whose round is over.
#[derive(Debug)]
pub(super) enum DueStep {
    /// It waits for a thread.
    Waiting(Box<Step>),
    /// A thread takes it under this number.
    Taken(u64),
}

impl Step {
    /// Returns the id of the calibration.
    pub fn calibration(&self) -> i64 {
        self.calibration
    }

    /// Returns the number of the step, which no other step of a farm has.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Returns whether the step may take more than a second.
    pub fn is_long(&self) -> bool {
        /// The number of results of which a sampler makes less than a second.
        const SHORT: usize = 5_000;
        // An emulator is fitted and sampled within one step, however few results it is told.
        let is_emulated = matches!(self.engine, CalibrationEngine::Emulated(_));
        self.answers > SHORT || is_emulated || self.engine.discovery().is_some()
    }

    /// Takes the step.
    #[must_use]
    pub fn run(mut self) -> Stepped {
        let calibration = self.calibration;
        let stages = self.engine.stages().len();
        let progress = self.engine.tell(self.particle, &self.row, self.values.as_deref());
        let stage = |record: &inference::StageRecord| Fact::Stage {
            calibration,
            record: Box::new(record.clone()),
            busy_ms: self.busy_ms,
        };
        let mut facts: Vec<Fact> = self.engine.stages()[stages..].iter().map(stage).collect();
        let mut draws = None;
        if matches!(progress, Ok(TellProgress::Finished)) {
            match self.engine.finding() {
                Some(CalibrationResult::Posterior(posterior)) => {
                    draws = Some(FinalDraws::from_posterior(posterior));
                    facts.push(Fact::Posterior {
                        calibration,
                        posterior: Box::new(posterior.clone()),
                        emulator: self.engine.emulator().cloned().map(Box::new),
                    });
                }
                Some(CalibrationResult::Estimate(estimate)) => {
                    draws = Some(FinalDraws::from_estimate(estimate, self.has_histories));
                    facts.push(Fact::Estimate {
                        calibration,
                        estimate: Box::new(estimate.clone()),
                    });
                }
                Some(CalibrationResult::Discovery(record)) => {
                    facts.push(Fact::Discovery { calibration, record });
                }
                None => {}
            }
        }
        Stepped {
            calibration,
            number: self.number,
            engine: self.engine,
            progress,
            facts,
            draws,
        }
    }
}
