//! The result of a simulation: observables or a rejection.

use record::{Fingerprint, RejectionReason};
use shared::outcome::{Fault, Observables, Outcome};

/// The result of an evaluation that did not fail.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationResult(pub Result<Observables, RejectionReason>);

/// The reason why a message is not a result. The calibration stays unchanged; the caller counts a failed attempt of the machine.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ResultError {
    /// The machine failed.
    #[error("{0}")]
    Fault(String),
    /// The observables do not have one entry for each run.
    #[error("the observables of evaluation {evaluation} do not cover the {runs} conditions of the variant")]
    WrongShape {
        /// Number of the evaluation.
        evaluation: u64,
        /// The expected number of entries.
        runs: usize,
    },
}

impl SimulationResult {
    /// Makes a result from a worker's outcome.
    ///
    /// # Errors
    /// [`ResultError::Fault`] with the machine's message.
    pub fn new(outcome: Outcome) -> Result<Self, ResultError> {
        match outcome {
            Outcome::Evaluated(observables) => Ok(SimulationResult(Ok(observables))),
            Outcome::Rejected(r) => {
                let reason = format!("{}: condition {}: {}", r.kind, r.condition, r.message);
                Ok(SimulationResult::refused(reason))
            }
            Outcome::Fault(Fault { message }) => Err(ResultError::Fault(message)),
        }
    }

    /// Makes the result of a rejection by the model.
    pub fn refused(reason: impl Into<String>) -> Self {
        SimulationResult(Err(RejectionReason(reason.into())))
    }

    /// Returns the fingerprint that a second computation of the evaluation must reproduce.
    pub fn fingerprint(&self) -> Fingerprint {
        Fingerprint(match &self.0 {
            Ok(observables) => observables.fingerprint().cast_signed(),
            // Rejections are compared by their texts.
            Err(reason) => reason
                .0
                .bytes()
                .fold(7, |hash: i64, b| hash.wrapping_mul(31).wrapping_add(i64::from(b))),
        })
    }
}
