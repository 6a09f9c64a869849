//! The result of an evaluation: observables or a rejection.

use record::Fingerprint;
use shared::exchange::WorkResult;
use shared::outcome::{Observables, Outcome};
use statistics::{Prior, SubchainEnd};

/// The result of an evaluation that no machine failed at.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationResult {
    /// Where the subchain ended, if one was asked for.
    pub end: Option<SubchainEnd>,
    /// Observables, or why the model refused; `None` where a subchain stayed at its start.
    pub outcome: Option<Result<Observables, String>>,
}

impl From<Result<Observables, String>> for SimulationResult {
    fn from(outcome: Result<Observables, String>) -> Self {
        SimulationResult {
            end: None,
            outcome: Some(outcome),
        }
    }
}

impl SimulationResult {
    /// Turns what a worker says into what a calibration takes.
    ///
    /// # Errors
    /// What the machine said that failed: a fault is no result.
    pub fn of(result: WorkResult) -> Result<SimulationResult, String> {
        let outcome = result.outcome.map(result_of).transpose()?;
        let end = result.end;
        Ok(SimulationResult { end, outcome })
    }

    /// Whether it answers what was asked: of a subchain of so many moves its end, at parameters that the prior allows, with
    /// something evaluated there where it moved; of anything else an outcome alone.
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

    /// What a second computation of the same evaluation must agree with.
    pub fn fingerprint(&self) -> Fingerprint {
        let outcome = match &self.outcome {
            None => 0,
            Some(Ok(observables)) => observables.fingerprint().cast_signed(),
            // A refusal is compared by its text.
            Some(Err(reason)) => reason
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
