//! Show a sampler's state to the outside.

use super::record::{PosteriorSample, StageProgress, StageRecord};
use super::sampler::{Sampler, SamplerPhase};
use super::settings::TmcmcSettings;
use crate::round::{InferenceFailure, Proposal};
use statistics::Metamodel;
use statistics::prior::Prior;

impl Sampler {
    /// The prior.
    #[must_use]
    pub fn prior(&self) -> &Prior {
        &self.prior
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &TmcmcSettings {
        &self.settings
    }

    /// Number of completed rounds; (round, particle) names an evaluation for ever.
    #[must_use]
    pub fn round(&self) -> u64 {
        self.round.number()
    }

    /// This round's proposals, by ascending particle, told or not.
    ///
    /// Those outside the prior's support are rejected at once and never listed. Empty only when the sampler
    /// has finished or failed.
    #[must_use]
    pub fn pending(&self) -> &[Proposal] {
        self.round.pending()
    }

    /// What takes the subchains of the stage in progress; `None` without a metamodel, and while the prior is drawn.
    #[must_use]
    pub fn metamodel(&self) -> Option<&Metamodel> {
        match &self.phase {
            SamplerPhase::Moving(stage) => stage.metamodel.as_deref(),
            SamplerPhase::Prior | SamplerPhase::Done | SamplerPhase::Failed(_) => None,
        }
    }

    /// Whether a pending particle has been told.
    #[must_use]
    pub fn is_told(&self, particle: usize) -> bool {
        self.round.is_told(particle)
    }

    /// The finished stages.
    #[must_use]
    pub fn stages(&self) -> &[StageRecord] {
        &self.stages
    }

    /// The result, once finished.
    #[must_use]
    pub fn posterior(&self) -> Option<&PosteriorSample> {
        self.posterior.as_ref()
    }

    /// Why the sampler failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        if let SamplerPhase::Failed(failure) = self.phase {
            Some(failure)
        } else {
            None
        }
    }

    /// Log-likelihoods told so far in completed rounds.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Those of them that were impossible.
    #[must_use]
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// The stage in progress, for display; the last stage once finished.
    #[must_use]
    pub fn current(&self) -> StageProgress {
        let (told, proposals) = (self.round.told(), self.round.pending().len());
        let mut current = StageProgress {
            stage: 0,
            tempering_exponent: 0.0,
            step: 0,
            most_steps: 1,
            acceptance: None,
            told,
            proposals,
        };
        if let SamplerPhase::Moving(stage) = &self.phase {
            current.stage = stage.index;
            current.tempering_exponent = stage.exponent;
            current.step = stage.step;
            current.most_steps = stage.chains.iter().map(|chain| chain.length).max().unwrap_or(0);
            current.acceptance = stage.acceptance();
        } else if let Some(last) = self.stages.last() {
            current.stage = last.stage;
            current.tempering_exponent = last.tempering_exponent;
            current.step = last.steps;
            current.most_steps = last.steps;
            current.acceptance = Some(last.acceptance);
        }
        current
    }
}
