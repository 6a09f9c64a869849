//! Brings a calibration to where it stood, from what the store kept.

use std::collections::BTreeMap;

use inference::LogLikelihood;
use shared::api::CalibrationState;

use super::Calibration;
use crate::fact::Fact;

/// What the store kept of a calibration that is not over.
#[derive(Debug, Default)]
pub struct Stored {
    /// The state that it was left in.
    pub state: Option<CalibrationState>,
    /// Why it was paused.
    pub message: Option<String>,
    /// The pinned version of the equations.
    pub model_version: Option<String>,
    /// Wall time spent before [ms].
    pub busy_ms: u64,
    /// Its evaluations by number: parameter vector, log-likelihood, whether the model refused.
    pub evaluations: BTreeMap<u64, StoredEvaluation>,
    /// Failed leases by evaluation.
    pub failed: BTreeMap<u64, u32>,
}

/// An evaluation as far as a replay needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredEvaluation {
    /// Parameter vector.
    pub theta: Vec<f64>,
    /// Log-likelihood; `None` where the model refused or nothing was scored.
    pub log_likelihood: Option<f64>,
    /// Whether the model refused.
    pub rejected: bool,
}

/// Why a stored calibration cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReplayError {
    /// The parameter vector that the sampler proposes differs from the stored one.
    #[error(
        "evaluation {evaluation} was stored at {stored:?}, but this version proposes {proposed:?}: the stored calibration was begun by another version of the sampler"
    )]
    OtherTheta {
        /// The evaluation.
        evaluation: u64,
        /// What the store has.
        stored: Vec<f64>,
        /// What the sampler proposes.
        proposed: Vec<f64>,
    },
    /// The stored log-likelihood is no number.
    #[error("evaluation {evaluation} was stored with a log-likelihood that is no number")]
    NotANumber {
        /// The evaluation.
        evaluation: u64,
    },
}

impl Calibration {
    /// Tells the stored evaluations again, round by round, as if they had just come in.
    ///
    /// Returns facts that may have been lost between the last evaluation and its consequences.
    ///
    /// # Errors
    /// [`ReplayError`] where the store and the sampler disagree.
    pub fn replay(&mut self, stored: Stored) -> Result<Vec<Fact>, ReplayError> {
        self.model_version = stored.model_version;
        self.busy_ms = stored.busy_ms;
        self.failed = stored.failed;
        self.ask();
        let mut facts = Vec::new();
        loop {
            let (round, drawing) = (self.sampler.round(), self.draws.is_some());
            for evaluation in self.queue.asked() {
                if let Some(row) = stored.evaluations.get(&evaluation) {
                    self.tell_again(evaluation, row, &mut facts)?;
                }
            }
            let moved = self.sampler.round() != round || self.draws.is_some() != drawing;
            if !moved || self.state.is_final() {
                break;
            }
        }
        if !self.state.is_final() {
            self.state = match stored.state {
                Some(CalibrationState::Paused) => CalibrationState::Paused,
                _ if self.evaluations == 0 => CalibrationState::Queued,
                _ => CalibrationState::Running,
            };
            self.message = stored.message;
        }
        Ok(facts)
    }

    fn tell_again(
        &mut self,
        evaluation: u64,
        stored: &StoredEvaluation,
        facts: &mut Vec<Fact>,
    ) -> Result<(), ReplayError> {
        let proposed = self.theta(evaluation).unwrap_or_default().to_vec();
        let same = proposed.len() == stored.theta.len()
            && proposed.iter().zip(&stored.theta).all(|(a, b)| a.to_bits() == b.to_bits());
        if !same {
            return Err(ReplayError::OtherTheta { evaluation, stored: stored.theta.clone(), proposed });
        }
        let scored = match (self.draws.is_some(), stored.log_likelihood) {
            (true, _) => None,
            (false, None) => Some(LogLikelihood::Impossible),
            (false, Some(value)) => {
                Some(LogLikelihood::new(value).map_err(|_| ReplayError::NotANumber { evaluation })?)
            }
        };
        self.queue.complete(evaluation);
        self.record(evaluation, stored.rejected, scored, facts);
        Ok(())
    }
}
