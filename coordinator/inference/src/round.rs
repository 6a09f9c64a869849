//! A round: proposals that can be evaluated at the same time, and their results in any order.

use crate::tell::TellError;

/// A parameter vector to be evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// Index of the particle, or of the trial point of a fit; with the number of the round it identifies the evaluation.
    pub particle: usize,
    /// The parameters, in the order of the prior.
    pub theta: Vec<f64>,
}

impl Proposal {
    /// Makes a proposal.
    #[must_use]
    pub fn new(particle: usize, theta: Vec<f64>) -> Self {
        Self { particle, theta }
    }
}

/// The proposals of a round with the results told so far, and the number of completed rounds.
#[derive(Debug, Clone)]
pub struct ProposalRound<A> {
    number: u64,
    /// The proposals by ascending particle.
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
    /// Opens a round with these proposals, by ascending particle.
    pub fn ask(&mut self, proposals: Vec<Proposal>) {
        self.missing = proposals.len();
        self.answers = proposals.iter().map(|_| None).collect();
        self.pending = proposals;
    }

    /// Takes the result of a pending particle; returns whether it was the last one of the round.
    ///
    /// # Errors
    /// [`TellError::NotPending`] or [`TellError::AlreadyTold`]; the round is unchanged then.
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

    /// Closes the round; returns its proposals and their results, in the same order.
    pub fn complete(&mut self) -> (Vec<Proposal>, Vec<A>) {
        self.number += 1;
        let answers = self.answers.drain(..).flatten().collect();
        (std::mem::take(&mut self.pending), answers)
    }

    /// Returns the number of completed rounds.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Returns the proposals, told or not.
    #[must_use]
    pub fn pending(&self) -> &[Proposal] {
        &self.pending
    }

    /// Returns the number of proposals that have been told.
    #[must_use]
    pub fn told(&self) -> usize {
        self.pending.len() - self.missing
    }

    /// Returns whether a pending particle has been told.
    #[must_use]
    pub fn is_told(&self, particle: usize) -> bool {
        self.slot(particle)
            .is_some_and(|slot| self.answers[slot].is_some())
    }

    /// Returns the proposal of a pending particle.
    #[must_use]
    pub fn proposal(&self, particle: usize) -> Option<&Proposal> {
        self.slot(particle).map(|slot| &self.pending[slot])
    }

    /// Returns the position of a particle among the pending proposals.
    fn slot(&self, particle: usize) -> Option<usize> {
        self.pending
            .binary_search_by_key(&particle, |proposal| proposal.particle)
            .ok()
    }
}
