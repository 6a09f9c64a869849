//! Hold a round: proposals that can be evaluated at the same time, and their results in any order.

use statistics::Subchain;
use statistics::likelihood::LikelihoodError;

/// A parameter vector that awaits its evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// Index of the particle, or of the candidate of a fit; with the round it names the evaluation for ever.
    pub particle: usize,
    /// The parameters, in the order of the prior.
    pub theta: Vec<f64>,
    /// The moves to take from there before the model is asked at their end; `None`: it is asked there.
    pub subchain: Option<Subchain>,
}

impl Proposal {
    /// A proposal to be evaluated where it is.
    #[must_use]
    pub fn plain(particle: usize, theta: Vec<f64>) -> Self {
        Self {
            particle,
            theta,
            subchain: None,
        }
    }
}

/// The proposals of a round with the results told so far, and the count of completed rounds.
#[derive(Debug, Clone)]
pub struct ProposalRound<A> {
    number: u64,
    /// By ascending particle.
    pending: Vec<Proposal>,
    answers: Vec<Option<A>>,
    missing: usize,
}

impl<A> Default for ProposalRound<A> {
    fn default() -> Self {
        Self {
            number: 0,
            pending: Vec::new(),
            answers: Vec::new(),
            missing: 0,
        }
    }
}

impl<A> ProposalRound<A> {
    /// Lists proposals, by ascending particle.
    pub fn ask(&mut self, proposals: Vec<Proposal>) {
        self.missing = proposals.len();
        self.answers = proposals.iter().map(|_| None).collect();
        self.pending = proposals;
    }

    /// Takes the result of a pending particle; whether it was the last one of the round.
    ///
    /// # Errors
    /// [`TellError::NotPending`], [`TellError::AlreadyTold`].
    pub fn tell(&mut self, particle: usize, answer: A) -> Result<bool, TellError> {
        let round = self.number;
        let slot = self
            .slot(particle)
            .ok_or(TellError::NotPending { round, particle })?;
        if self.answers[slot].is_some() {
            return Err(TellError::AlreadyTold { round, particle });
        }
        self.answers[slot] = Some(answer);
        self.missing -= 1;
        Ok(self.missing == 0)
    }

    /// Completes the round: its proposals with their results, in the order of the proposals.
    pub fn complete(&mut self) -> (Vec<Proposal>, Vec<A>) {
        self.number += 1;
        let answers = self.answers.drain(..).flatten().collect();
        (std::mem::take(&mut self.pending), answers)
    }

    /// Number of completed rounds.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// The proposals, told or not.
    #[must_use]
    pub fn pending(&self) -> &[Proposal] {
        &self.pending
    }

    /// How many of them have been told.
    #[must_use]
    pub fn told(&self) -> usize {
        self.pending.len() - self.missing
    }

    /// Whether a pending particle has been told.
    #[must_use]
    pub fn is_told(&self, particle: usize) -> bool {
        self.slot(particle)
            .is_some_and(|slot| self.answers[slot].is_some())
    }

    /// The proposal of a pending particle.
    #[must_use]
    pub fn proposal(&self, particle: usize) -> Option<&Proposal> {
        self.slot(particle).map(|slot| &self.pending[slot])
    }

    /// Position of a particle among the pending proposals.
    fn slot(&self, particle: usize) -> Option<usize> {
        self.pending
            .binary_search_by_key(&particle, |proposal| proposal.particle)
            .ok()
    }
}

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
    /// It cannot go on.
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
