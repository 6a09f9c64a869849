//! Show a search's state to the outside.

use super::generations::{Evolution, EvolutionPhase};
use super::settings::EvolutionSettings;
use crate::evolution::individual::Individual;
use crate::point_estimate::ModeEstimate;
use crate::round::{InferenceFailure, Proposal};
use statistics::prior::Prior;

/// A search in progress, for display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EvolutionProgress {
    /// Generations completed so far.
    pub generations: usize,
    /// ln posterior of the best point so far, in nats; `None` while the model rejected everything.
    pub log_posterior: Option<f64>,
    /// Proposals of this round that have been told.
    pub told: usize,
    /// Proposals of this round.
    pub proposals: usize,
}

impl Evolution {
    /// The prior.
    #[must_use]
    pub fn prior(&self) -> &Prior {
        &self.space.prior
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &EvolutionSettings {
        &self.settings
    }

    /// Number of completed rounds; (round, particle) names an evaluation for ever.
    #[must_use]
    pub fn round(&self) -> u64 {
        self.round.number()
    }

    /// This round's proposals, by ascending index, told or not; empty only when the search has ended.
    #[must_use]
    pub fn pending(&self) -> &[Proposal] {
        self.round.pending()
    }

    /// Whether a pending proposal has been told.
    #[must_use]
    pub fn is_told(&self, particle: usize) -> bool {
        self.round.is_told(particle)
    }

    /// The result, once finished.
    #[must_use]
    pub fn estimate(&self) -> Option<&ModeEstimate> {
        if let EvolutionPhase::Done(estimate) = &self.phase {
            Some(estimate)
        } else {
            None
        }
    }

    /// Why the search failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        if let EvolutionPhase::Failed(failure) = self.phase {
            Some(failure)
        } else {
            None
        }
    }

    /// Evaluations told so far in completed rounds.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        self.evaluations as u64
    }

    /// Those of them that the model rejected.
    #[must_use]
    pub fn rejected(&self) -> u64 {
        self.rejected as u64
    }

    /// Where the search stands, for display.
    #[must_use]
    pub fn current(&self) -> EvolutionProgress {
        EvolutionProgress {
            generations: self.history.len(),
            log_posterior: self.best.as_ref().map(Individual::log_posterior),
            told: self.round.told(),
            proposals: self.round.pending().len(),
        }
    }
}
