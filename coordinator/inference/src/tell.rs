//! The progress after a told result, and the errors of telling.

use statistics::likelihood::LikelihoodError;

/// The progress after a told result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TellProgress {
    /// The round has untold proposals left.
    Waiting,
    /// New proposals are pending.
    NextRound,
    /// A stage ended and new proposals are pending.
    StageFinished,
    /// The algorithm has finished.
    Finished,
    /// The algorithm has failed.
    Failed(InferenceFailure),
}

/// The reasons for which a sampler or a point estimate fails.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum InferenceFailure {
    /// The model rejected every prior draw.
    #[error("all {draws} prior draws were rejected by the model")]
    AllImpossible {
        /// Number of prior draws.
        draws: usize,
    },
    /// The model accepted too few prior draws.
    #[error("the model accepted only {possible} of {draws} prior draws, at least {needed} are needed")]
    TooFewPossible {
        /// Number of accepted draws.
        possible: usize,
        /// Number of prior draws.
        draws: usize,
        /// Number of draws needed.
        needed: usize,
    },
    /// The next exponent equals the last in floating point.
    #[error("tempering exponent {exponent} cannot grow by {step}: the log-likelihoods differ too much")]
    ExponentStuck {
        /// The tempering exponent of the last stage.
        exponent: f64,
        /// The step of the tempering exponent that is too small.
        step: f64,
    },
}

/// The reasons for which a told result is refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TellError {
    /// The particle was told before in this round.
    #[error("particle {particle} was told before in round {round}")]
    AlreadyTold {
        /// Number of the round.
        round: u64,
        /// Index of the particle.
        particle: usize,
    },
    /// The particle has no proposal in this round.
    #[error("particle {particle} has no proposal in round {round}")]
    NotPending {
        /// Number of the round.
        round: u64,
        /// Index of the particle.
        particle: usize,
    },
    /// The predicted values are not one for each datum.
    #[error("{given} predicted values for {expected} data")]
    Length {
        /// Number of values that the likelihood takes.
        expected: usize,
        /// Number of values that were told.
        given: usize,
    },
    /// The predicted values cannot be scored.
    #[error(transparent)]
    Likelihood(#[from] LikelihoodError),
}
