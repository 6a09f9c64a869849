//! The result of a simulation: observables or a rejection.

use record::{Fingerprint, RejectionReason};
use shared::outcome::{Fault, Observables, Outcome};
use statistics::{Prior, SubchainEnd};

/// The result of an evaluation that did not fail.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationResult {
    /// The end of the subchain, if the question has one.
    pub end: Option<SubchainEnd>,
    /// Observables, or the reason of a rejection; `None` where a subchain stayed at its start.
    pub outcome: Option<Result<Observables, RejectionReason>>,
}

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
    /// The end of a subchain is missing, unexpected or impossible.
    #[error("the result of evaluation {evaluation} does not answer what its lease asked for")]
    OtherQuestion {
        /// Number of the evaluation.
        evaluation: u64,
    },
}

impl SimulationResult {
    /// Makes a result from a worker's outcome.
    ///
    /// # Errors
    /// [`ResultError::Fault`] with the machine's message.
    pub fn new(outcome: Option<Outcome>, end: Option<SubchainEnd>) -> Result<Self, ResultError> {
        let outcome = match outcome {
            None => None,
            Some(Outcome::Evaluated(observables)) => Some(Ok(observables)),
            Some(Outcome::Rejected(r)) => {
                let reason = format!("{}: condition {}: {}", r.kind, r.condition, r.message);
                Some(Err(RejectionReason(reason)))
            }
            Some(Outcome::Fault(Fault { message })) => return Err(ResultError::Fault(message)),
        };
        Ok(SimulationResult { end, outcome })
    }

    /// Makes the result of a rejection by the model.
    pub fn refused(reason: impl Into<String>) -> Self {
        SimulationResult {
            end: None,
            outcome: Some(Err(RejectionReason(reason.into()))),
        }
    }

    /// Returns whether the result answers its question. The end of a subchain has at most `moves` moves, parameters that the prior allows,
    /// and an outcome exactly if it moved; any other question needs an outcome alone.
    pub(super) fn answers(&self, subchain: bool, moves: usize, prior: impl FnOnce() -> Prior) -> bool {
        match &self.end {
            None => !subchain && self.outcome.is_some(),
            Some(end) => {
                subchain
                    && prior().log_density(&end.theta) > f64::NEG_INFINITY
                    && end.log_gain.is_finite()
                    && end.moves as usize <= moves
                    && end.accepted <= end.moves
                    && end.scaled <= end.moves
                    && end.scaled_accepted <= end.scaled.min(end.accepted)
                    && (end.accepted > 0) == self.outcome.is_some()
            }
        }
    }

    /// Returns the fingerprint that a second computation of the evaluation must reproduce.
    pub fn fingerprint(&self) -> Fingerprint {
        let outcome = match &self.outcome {
            None => 0,
            Some(Ok(observables)) => observables.fingerprint().cast_signed(),
            // Rejections are compared by their texts.
            Some(Err(reason)) => reason
                .0
                .bytes()
                .fold(7, |hash: i64, b| hash.wrapping_mul(31).wrapping_add(i64::from(b))),
        };
        let end = self.end.as_ref().into_iter();
        let bits = end.flat_map(|end| {
            let numbers = end.theta.iter().copied().chain([end.log_gain]).map(f64::to_bits);
            let counts = [end.moves, end.accepted, end.scaled, end.scaled_accepted];
            numbers.chain(counts.map(u64::from))
        });
        Fingerprint(bits.fold(outcome, |hash, bits| {
            hash.wrapping_mul(31).wrapping_add(bits.cast_signed())
        }))
    }
}

#[cfg(test)]
mod tests {
    use statistics::{Distribution, Marginal};

    use super::*;

    /// Changes an honest end; whether it is still an answer to a subchain of ten moves.
    fn answers(change: fn(&mut SubchainEnd)) -> bool {
        let unit = Distribution::Loguniform {
            lower: 1.0,
            upper: 2.0,
        };
        let prior = Prior::new(vec![Marginal::new(unit, None).unwrap()]);
        let mut end = SubchainEnd {
            theta: vec![1.5],
            log_gain: -0.5,
            moves: 10,
            accepted: 3,
            scaled: 8,
            scaled_accepted: 2,
        };
        change(&mut end);
        let computed = SimulationResult {
            end: Some(end),
            outcome: Some(Ok(Observables::default())),
        };
        assert!(
            !computed.answers(false, 10, || prior.clone()),
            "nobody asked for a subchain"
        );
        computed.answers(true, 10, || prior)
    }

    #[test]
    fn an_end_that_no_subchain_can_have_is_no_answer() {
        assert!(answers(|_| ()));
        let wrong: [fn(&mut SubchainEnd); 9] = [
            |end| end.theta = vec![-1.0],
            |end| end.theta = vec![f64::NAN],
            |end| end.theta.clear(),
            |end| end.log_gain = f64::INFINITY,
            |end| end.moves = 11,
            |end| end.accepted = 11,
            |end| end.accepted = 0,
            |end| end.scaled = u32::MAX,
            |end| end.scaled_accepted = 4,
        ];
        for (i, change) in wrong.into_iter().enumerate() {
            assert!(!answers(change), "{i}");
        }
    }
}
