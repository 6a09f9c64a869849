//! What telling a result leads to, and why one is refused.

use statistics::likelihood::LikelihoodError;

/// What a told result led to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TellProgress {
    /// The round still waits for others.
    Waiting,
    /// New proposals are pending.
    NextRound,
    /// A stage ended and new proposals are pending.
    StageFinished,
    /// The result is there.
    Finished,
    /// The algorithm cannot go on.
    Failed(InferenceFailure),
}

/// Why a sampler or a fit cannot go on.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum InferenceFailure {
    /// No prior draw was possible.
    #[error("all {draws} prior draws were rejected by the model")]
    AllImpossible {
        /// Number of prior draws.
        draws: usize,
    },
    /// Too few prior draws were possible.
    #[error("only {possible} of {draws} prior draws were possible, at least {needed} are needed")]
    TooFewPossible {
        /// Possible draws.
        possible: usize,
        /// Prior draws.
        draws: usize,
        /// Draws needed.
        needed: usize,
    },
    /// The metamodel's predictions cannot be scored.
    #[error("the metamodel: {0}")]
    Metamodel(LikelihoodError),
    /// The next exponent cannot be told from the last.
    #[error("tempering exponent {exponent} cannot grow by {step}: the log-likelihoods differ too much")]
    ExponentStuck {
        /// The last exponent.
        exponent: f64,
        /// The step.
        step: f64,
    },
}

/// A result that nobody asked for, or that fits nothing.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TellError {
    /// The particle was told before in this round.
    #[error("particle {particle} was told before in round {round}")]
    AlreadyTold {
        /// The round.
        round: u64,
        /// The particle.
        particle: usize,
    },
    /// The particle has no proposal in this round.
    #[error("particle {particle} has no proposal in round {round}")]
    NotPending {
        /// The round.
        round: u64,
        /// The particle.
        particle: usize,
    },
    /// The predicted values are not one for each datum.
    #[error("{given} predicted values for {expected} data")]
    Length {
        /// Data.
        expected: usize,
        /// Predicted values.
        given: usize,
    },
    /// A particle was to be evaluated where it is, and came back from a subchain, or the other way round.
    #[error("particle {particle} of round {round} was told what was not asked of it")]
    NotAsked {
        /// The round.
        round: u64,
        /// The particle.
        particle: usize,
    },
    /// The predicted values cannot be scored.
    #[error(transparent)]
    Likelihood(#[from] LikelihoodError),
}
