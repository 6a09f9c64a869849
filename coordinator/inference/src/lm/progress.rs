//! Show a fit's state to the outside.

use super::fit::{FitPhase, LmFit};
use super::settings::LmSettings;
use crate::point_estimate::ModeEstimate;
use crate::round::{InferenceFailure, Proposal};
use statistics::prior::Prior;

/// A fit in progress, for display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitProgress {
    /// Steps taken so far.
    pub steps: usize,
    /// ln posterior of the best point so far, in nats; `None` before the first round is complete.
    pub log_posterior: Option<f64>,
    /// Proposals of this round that have been told.
    pub told: usize,
    /// Proposals of this round.
    pub proposals: usize,
}

impl LmFit {
    /// The prior.
    #[must_use]
    pub fn prior(&self) -> &Prior {
        &self.objective.prior
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &LmSettings {
        &self.settings
    }

    /// Number of completed rounds; (round, particle) names an evaluation for ever.
    #[must_use]
    pub fn round(&self) -> u64 {
        self.round.number()
    }

    /// This round's proposals, by ascending index, told or not; empty only when the fit has ended.
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
        if let FitPhase::Done(estimate) = &self.phase {
            Some(estimate)
        } else {
            None
        }
    }

    /// Why the fit failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        if let FitPhase::Failed(failure) = self.phase {
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

    /// Where the fit stands, for display.
    #[must_use]
    pub fn current(&self) -> FitProgress {
        FitProgress {
            steps: self.steps,
            log_posterior: self.best.as_ref().map(|point| -point.value),
            told: self.round.told(),
            proposals: self.round.pending().len(),
        }
    }
}
