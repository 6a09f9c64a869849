//! The phases of a calibration between its first draw and its end.

use super::final_draws::FinalDraws;

/// The phase of a calibration. A search has no final draws; a calibration without rejected holdout runs skips their phase.
#[derive(Debug, Default)]
pub(super) enum Phase {
    /// The engine proposes evaluations.
    #[default]
    Sampling,
    /// The final draws are simulated on fitted and holdout runs.
    FinalDraws(FinalDraws),
    /// The holdout runs are simulated one by one, at the draws at which the model rejects them together.
    RefusedRuns(FinalDraws),
    /// Everything is evaluated, and answers wait to be compared. The draws are kept, because late answers refer to them.
    Comparing(Option<FinalDraws>),
}

impl Phase {
    /// Returns the phase after this one.
    pub(super) fn next(self) -> Phase {
        match self {
            Phase::Sampling => Phase::Comparing(None),
            Phase::FinalDraws(draws) if !draws.refused.is_empty() => Phase::RefusedRuns(draws),
            Phase::FinalDraws(draws) | Phase::RefusedRuns(draws) => Phase::Comparing(Some(draws)),
            Phase::Comparing(draws) => Phase::Comparing(draws),
        }
    }

    pub(super) fn is_sampling(&self) -> bool {
        matches!(self, Phase::Sampling)
    }

    /// Returns the final draws, once they are known.
    pub(super) fn draws(&self) -> Option<&FinalDraws> {
        match self {
            Phase::Sampling => None,
            Phase::FinalDraws(draws) | Phase::RefusedRuns(draws) => Some(draws),
            Phase::Comparing(draws) => draws.as_ref(),
        }
    }
}
