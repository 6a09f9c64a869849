//! What came out of an evaluation that no machine failed at.

use inference::SubchainEnd;
use shared::exchange::WorkResult;
use shared::outcome::{Observables, Outcome};

/// What a model said, or that it had not to be asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Computed {
    /// Where the subchain ended, if one was asked for.
    pub end: Option<SubchainEnd>,
    /// Observables, or why the model refused; `None` where a subchain stayed at its start.
    pub outcome: Option<Result<Observables, String>>,
}

impl From<Result<Observables, String>> for Computed {
    fn from(outcome: Result<Observables, String>) -> Self {
        Computed {
            end: None,
            outcome: Some(outcome),
        }
    }
}

impl Computed {
    /// Turns what a worker says into what a calibration takes.
    ///
    /// # Errors
    /// What the machine said that failed: a fault is no result.
    pub fn of(result: WorkResult) -> Result<Computed, String> {
        let outcome = result.outcome.map(result_of).transpose()?;
        let end = result.end;
        Ok(Computed { end, outcome })
    }

    /// Whether it answers what was asked: of a subchain its end, with parameters of this number, and something evaluated
    /// there where it moved; of anything else an outcome alone.
    pub(super) fn answers(&self, subchain: bool, dimension: usize) -> bool {
        match &self.end {
            None => !subchain && self.outcome.is_some(),
            Some(end) => {
                subchain
                    && end.theta.len() == dimension
                    && end.theta.iter().all(|x| x.is_finite())
                    && end.log_gain.is_finite()
                    && (end.accepted > 0) == self.outcome.is_some()
            }
        }
    }

    /// Whether the model refused.
    pub(super) fn is_refused(&self) -> bool {
        matches!(self.outcome, Some(Err(_)))
    }
}

/// Turns an outcome into observables or a refusal.
///
/// # Errors
/// What the machine said that failed.
pub fn result_of(outcome: Outcome) -> Result<Result<Observables, String>, String> {
    match outcome {
        Outcome::Evaluated(observables) => Ok(Ok(observables)),
        Outcome::Rejected(r) => Ok(Err(format!(
            "{}: condition {}: {}",
            r.kind, r.condition, r.message
        ))),
        Outcome::Fault(fault) => Err(fault.message),
    }
}
