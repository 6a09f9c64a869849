//! Where a calibration is between its first draw and its end.

use super::final_draws::FinalDraws;

/// Where a calibration is. A search has no final draws; a calibration without refused holdout runs skips their phase.
#[derive(Debug, Default)]
pub(super) enum Phase {
    /// Sampler, fit, evolution or search asks for evaluations.
    #[default]
    Sampling,
    /// The final draws are simulated on fitted and holdout runs.
    FinalDraws(FinalDraws),
    /// The holdout runs of the draws at which the model refuses them together are simulated one by one.
    RefusedRuns(FinalDraws),
    /// Everything is evaluated, and answers wait to be compared. The draws tell what late answers answer.
    Comparing(Option<FinalDraws>),
}

impl Phase {
    /// The phase that follows when everything that this one asks for is there.
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

    /// The final draws, once they are known.
    pub(super) fn draws(&self) -> Option<&FinalDraws> {
        match self {
            Phase::Sampling => None,
            Phase::FinalDraws(draws) | Phase::RefusedRuns(draws) => Some(draws),
            Phase::Comparing(draws) => draws.as_ref(),
        }
    }
}
