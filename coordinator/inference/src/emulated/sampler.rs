//! The rounds of an emulated sampler: list proposals, take their outputs, advance.

use statistics::likelihood::Likelihood;
use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;

use super::emulator::{Emulator, KrigingSettings, TrainingPoint};
use super::record::EmulatorRecord;
use super::round::{EmulatedRound, Next, Outputs};
use super::sample::EmulatedSample;
use super::target::log_likelihood;
use crate::phase::{EvaluationCount, RunPhase};
use crate::round::{Proposal, ProposalRound};
use crate::tell::{InferenceFailure, TellError, TellProgress};
use crate::tmcmc::{PosteriorSample, StageProgress, StageRecord, TmcmcSettings, TmcmcSettingsError};

/// An ask/tell sampler whose stages are sampled on an emulator.
///
/// Its state is a function of prior, likelihood, settings and the told outputs, whatever their order within a round.
#[derive(Debug, Clone)]
pub struct EmulatedSampler {
    pub(super) prior: Prior,
    /// The likelihood as stated, and with the model's scatter once it was measured.
    pub(super) stated: Likelihood,
    pub(super) likelihood: Likelihood,
    pub(super) settings: TmcmcSettings,
    pub(super) has_measured_scatter: bool,
    /// Whether the outputs scatter about a smooth function of the parameters.
    pub(super) is_rough: bool,
    /// Number of parameters that the model takes, the first of theta.
    pub(super) model_parameters: usize,
    pub(super) round: ProposalRound<Outputs>,
    pub(super) phase: RunPhase<EmulatedRound, PosteriorSample>,
    pub(super) training: Vec<TrainingPoint>,
    /// The sample of the last stage below exponent 1; at first, prior draws.
    pub(super) wide: EmulatedSample,
    /// Hyperparameters of the last emulator in each kind of coordinates.
    pub(super) hyperparameters: [Option<KrigingSettings>; 2],
    /// The stages on the emulator: they are the result's only if the emulator is not given up.
    pub(super) emulated_stages: Vec<StageRecord>,
    pub(super) stages: Vec<StageRecord>,
    pub(super) record: EmulatorRecord,
    pub(super) count: EvaluationCount,
}

impl EmulatedSampler {
    /// Makes a sampler whose first round spreads points over the prior.
    ///
    /// # Arguments
    /// - `likelihood`: the data; their order is that of the values that [`EmulatedSampler::tell`] takes.
    /// - `model_parameters`: the number of parameters that the model takes, the first of theta; the others are error sds.
    ///
    /// # Errors
    /// [`TmcmcSettingsError`] names the setting, its value and its bound.
    pub fn new(
        prior: Prior,
        likelihood: Likelihood,
        settings: TmcmcSettings,
        model_parameters: usize,
    ) -> Result<Self, TmcmcSettingsError> {
        settings.check(prior.dimension())?;
        let mut sampler = Self {
            wide: EmulatedSample::from_prior(&prior, settings.seed),
            prior,
            stated: likelihood.clone(),
            likelihood,
            settings,
            has_measured_scatter: false,
            is_rough: false,
            model_parameters,
            round: ProposalRound::default(),
            phase: RunPhase::Waiting(EmulatedRound::Design),
            training: Vec::new(),
            hyperparameters: [None; 2],
            emulated_stages: Vec::new(),
            stages: Vec::new(),
            record: EmulatorRecord::default(),
            count: EvaluationCount::default(),
        };
        let design = sampler.design();
        sampler.ask(design);
        Ok(sampler)
    }

    /// Returns the round in progress; its list of proposals is empty only when the sampler has ended.
    #[must_use]
    pub fn round(&self) -> &ProposalRound<Option<Vec<f64>>> {
        &self.round
    }

    /// Returns whether the round in progress asks for final draws: if their weights are even enough, they are the posterior.
    #[must_use]
    pub fn asks_final_draws(&self) -> bool {
        matches!(self.phase, RunPhase::Waiting(EmulatedRound::Final(_)))
    }

    /// Returns the finished stages, all at once at the end: an emulator that is given up leaves none.
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

    /// Returns what the rounds found about the emulator.
    #[must_use]
    pub fn record(&self) -> &EmulatorRecord {
        &self.record
    }

    /// Returns the stage in progress, for display; the last stage once finished.
    #[must_use]
    pub fn progress(&self) -> StageProgress {
        // The stages are moved from the one list to the other at the end.
        let finished = self.emulated_stages.len().max(self.stages.len());
        let (stage, exponent) = match &self.phase {
            RunPhase::Waiting(EmulatedRound::Fallback(sampler)) => return sampler.progress(),
            RunPhase::Waiting(EmulatedRound::Design) => (0, 0.0),
            RunPhase::Waiting(EmulatedRound::Refinement(refinement)) => {
                (finished + 1, refinement.position.exponent)
            }
            RunPhase::Waiting(EmulatedRound::Scatter(line)) => (finished + 1, line.position.exponent),
            _ => (finished, 1.0),
        };
        StageProgress {
            stage,
            tempering_exponent: exponent,
            step: self.record.rounds.len(),
            acceptance: None,
        }
    }

    /// Takes the outputs of a pending proposal; the last ones of a round advance the sampler.
    ///
    /// # Arguments
    /// - `outputs`: the model's values as [`Likelihood::log_likelihood`] takes them; `None` where the model rejected the
    ///   parameters.
    ///
    /// # Errors
    /// [`TellError`] for a proposal that was told before or is not pending, or with a wrong number of outputs or infinite ones. The
    /// sampler is unchanged then.
    pub fn tell(&mut self, particle: usize, outputs: Option<&[f64]>) -> Result<TellProgress, TellError> {
        if let Some(values) = outputs {
            let (expected, given) = (self.likelihood.values(), values.len());
            if expected != given {
                return Err(TellError::Length { expected, given });
            }
            self.likelihood.check_values(values)?;
        }
        if !self.round.tell(particle, outputs.map(<[f64]>::to_vec))? {
            return Ok(TellProgress::Waiting);
        }
        let stages = self.stages.len();
        self.advance();
        Ok(match self.phase.progress(true) {
            TellProgress::NextRound if self.stages.len() > stages => TellProgress::StageFinished,
            progress => progress,
        })
    }

    fn advance(&mut self) {
        let (proposals, outputs) = self.round.complete();
        self.count.add(outputs.iter().map(Option::is_none));
        let phase = std::mem::replace(&mut self.phase, RunPhase::Waiting(EmulatedRound::Design));
        let next = match phase {
            RunPhase::Waiting(EmulatedRound::Fallback(sampler)) => {
                return self.continue_fallback(sampler, &proposals, &outputs);
            }
            RunPhase::Waiting(round) => {
                self.learn(&proposals, &outputs);
                match round {
                    EmulatedRound::Refinement(refinement) => self.after_refinement(*refinement, &outputs),
                    EmulatedRound::Scatter(line) => self.after_scatter(&line, &outputs),
                    EmulatedRound::Final(batch) => self.after_final(&batch, &outputs),
                    EmulatedRound::Design | EmulatedRound::Fallback(_) => {
                        let thetas: Vec<&[f64]> = proposals.iter().map(|p| p.theta.as_slice()).collect();
                        self.after_design(&thetas)
                    }
                }
            }
            ended @ (RunPhase::Done(_) | RunPhase::Failed(_)) => {
                self.phase = ended;
                return;
            }
        };
        match next {
            Next::Ask(round, thetas) => {
                self.phase = RunPhase::Waiting(round);
                self.ask(thetas);
            }
            Next::Done(sample) => self.phase = RunPhase::Done(sample),
            Next::GiveUp => self.give_up(),
        }
    }

    pub(super) fn ask(&mut self, thetas: Vec<Vec<f64>>) {
        let proposals = thetas.into_iter().enumerate();
        self.round.ask(
            proposals
                .map(|(particle, theta)| Proposal::new(particle, theta))
                .collect(),
        );
    }

    /// Returns the log-likelihood of outputs.
    pub(super) fn score(&self, outputs: Option<&[f64]>, theta: &[f64]) -> LogLikelihood {
        let scored = outputs.map(|outputs| self.likelihood.log_likelihood(outputs, theta));
        // An error sd of zero, from the tail of a prior, makes the data impossible.
        scored.and_then(Result::ok).unwrap_or(LogLikelihood::Impossible)
    }

    /// Returns the log-likelihood of a parameter vector by the model, or by the smooth part of a rough model: the prediction of an
    /// emulator that learnt these outputs.
    pub(super) fn judged(&self, outputs: &Outputs, theta: &[f64], learnt: &Emulator) -> LogLikelihood {
        if self.is_rough && outputs.is_some() {
            log_likelihood(self.target(learnt).score(theta).log_likelihood)
        } else {
            self.score(outputs.as_deref(), theta)
        }
    }
}
