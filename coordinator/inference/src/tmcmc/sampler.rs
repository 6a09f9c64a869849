//! The rounds of the sampler: list proposals, take their results, advance.

use super::draws::DrawStage;
use super::evidence::Evidence;
use super::record::{PosteriorSample, StageProgress, StageRecord};
use super::settings::{TmcmcSettings, TmcmcSettingsError};
use super::stage::Stage;
use super::transition::Passage;
use crate::phase::{EvaluationCount, RunPhase};
use crate::round::{Proposal, ProposalRound};
use crate::tell::{InferenceFailure, TellError, TellProgress};
use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;
use statistics::rng::Stream;

/// An ask/tell sampler.
///
/// A round is a set of proposals that can be evaluated at the same time; the sampler advances when all have
/// been told. Its state is a function of prior, settings and the told values, whatever their order.
#[derive(Debug, Clone)]
pub struct Sampler {
    pub(super) prior: Prior,
    pub(super) settings: TmcmcSettings,
    pub(super) round: ProposalRound<LogLikelihood>,
    pub(super) phase: SamplerPhase,
    pub(super) evidence: Evidence,
    pub(super) passage: Passage,
    pub(super) stages: Vec<StageRecord>,
    pub(super) count: EvaluationCount,
}

/// The pending evaluations of the sampler.
#[derive(Debug, Clone)]
pub(super) enum SamplerRound {
    /// The draws from the prior that start the sampler.
    Prior,
    /// Independent draws of a stage.
    Draws(Box<DrawStage>),
    /// Moves of the chains of a stage.
    Moves(Box<Stage>),
}

/// The position of a sampler in its sequence of stages.
pub(super) type SamplerPhase = RunPhase<SamplerRound, PosteriorSample>;

impl Sampler {
    /// Makes a sampler whose round 0 holds the prior draws.
    ///
    /// # Errors
    /// [`TmcmcSettingsError`] names the setting, its value and its bound.
    pub fn new(prior: Prior, settings: TmcmcSettings) -> Result<Self, TmcmcSettingsError> {
        settings.check(prior.dimension())?;
        let pending: Vec<Proposal> = (0..settings.particles)
            .map(|particle| {
                let mut stream = Stream::new(settings.seed, 0, particle as u64, 0);
                Proposal::new(particle, prior.sample(&mut stream))
            })
            .collect();
        let mut sampler = Self {
            prior,
            settings,
            round: ProposalRound::default(),
            phase: RunPhase::Waiting(SamplerRound::Prior),
            evidence: Evidence::default(),
            passage: Passage::default(),
            stages: Vec::new(),
            count: EvaluationCount::default(),
        };
        sampler.round.ask(pending);
        Ok(sampler)
    }

    /// Returns the round in progress.
    ///
    /// Proposals outside the prior's support are rejected at once and never listed. The list is empty only when the
    /// sampler has finished or failed.
    #[must_use]
    pub fn round(&self) -> &ProposalRound<LogLikelihood> {
        &self.round
    }

    /// Returns the finished stages.
    #[must_use]
    pub fn stages(&self) -> &[StageRecord] {
        &self.stages
    }

    /// Returns the result, once finished.
    #[must_use]
    pub fn posterior(&self) -> Option<&PosteriorSample> {
        self.phase.result()
    }

    /// Returns why the sampler failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        self.phase.failure()
    }

    /// Returns the stage in progress, for display; the last stage once finished.
    #[must_use]
    pub fn progress(&self) -> StageProgress {
        match (&self.phase, self.stages.last()) {
            (RunPhase::Waiting(SamplerRound::Moves(stage)), _) => StageProgress {
                stage: stage.index,
                tempering_exponent: stage.exponent,
                step: stage.step,
                acceptance: stage.acceptance(),
            },
            (RunPhase::Waiting(SamplerRound::Draws(stage)), _) => StageProgress {
                stage: stage.start.index,
                tempering_exponent: stage.exponent,
                step: stage.rounds,
                acceptance: None,
            },
            (_, Some(last)) => StageProgress {
                stage: last.stage,
                tempering_exponent: last.tempering_exponent,
                step: last.steps,
                acceptance: Some(last.acceptance),
            },
            (_, None) => StageProgress {
                stage: 0,
                tempering_exponent: 0.0,
                step: 0,
                acceptance: None,
            },
        }
    }

    /// Takes the log-likelihood of a pending particle; the last one of a round advances the sampler.
    ///
    /// # Errors
    /// [`TellError::AlreadyTold`] and [`TellError::NotPending`]; the sampler is then unchanged.
    pub fn tell(
        &mut self,
        particle: usize,
        log_likelihood: LogLikelihood,
    ) -> Result<TellProgress, TellError> {
        Ok(if self.round.tell(particle, log_likelihood)? {
            self.advance()
        } else {
            TellProgress::Waiting
        })
    }

    /// Completes rounds until proposals are pending or the sampler has ended.
    fn advance(&mut self) -> TellProgress {
        let stages = self.stages.len();
        loop {
            let (proposals, results) = self.round.complete();
            self.count
                .add(results.iter().map(|result| result.is_impossible()));
            let next = match std::mem::replace(&mut self.phase, RunPhase::Waiting(SamplerRound::Prior)) {
                RunPhase::Waiting(SamplerRound::Prior) => self.finish_prior(&proposals, results),
                RunPhase::Waiting(SamplerRound::Moves(mut stage)) => {
                    stage.accept(results);
                    self.after_step(stage)
                }
                RunPhase::Waiting(SamplerRound::Draws(mut stage)) => {
                    stage.accept(results);
                    self.after_draws(stage)
                }
                ended @ (RunPhase::Done(_) | RunPhase::Failed(_)) => Ok(ended),
            };
            self.phase = next.unwrap_or_else(RunPhase::Failed);
            match &mut self.phase {
                RunPhase::Waiting(SamplerRound::Moves(stage)) => {
                    let proposals = stage.propose(&self.prior, self.settings.seed);
                    self.round.ask(proposals);
                }
                RunPhase::Waiting(SamplerRound::Draws(stage)) => {
                    let proposals = stage.propose(&self.prior);
                    self.round.ask(proposals);
                }
                ended => return ended.progress(true),
            }
            if !self.round.pending().is_empty() {
                return if self.stages.len() > stages {
                    TellProgress::StageFinished
                } else {
                    TellProgress::NextRound
                };
            }
        }
    }
}
