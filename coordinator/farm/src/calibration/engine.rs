//! The engine of a calibration: sampler, fit, evolution or search. It proposes evaluations and is told their results.

use inference::evolution::Evolution;
use inference::lm::LmFit;
use inference::point_estimate::ModeEstimate;
use inference::{
    EmulatedSampler, EmulatorRecord, PosteriorSample, Proposal, Sampler, StageProgress, StageRecord,
    TellError, TellProgress,
};
use shared::api::{Position, SearchProgress};
use statistics::{LogLikelihood, NotANumber};

use super::outline::EngineOutline;
use super::witness::NOBODY;
use job::{AlgorithmSettings, AlgorithmSettingsError, Spec};
use record::{Discovery, EvaluationRow};
use search::{DiscoveryError, RunningDiscovery, SearchModels};

/// The algorithm that proposes evaluations and is told their results.
#[derive(Debug)]
pub enum CalibrationEngine {
    /// Samples the posterior; it is told log-likelihoods.
    Sampler(Box<Sampler>),
    /// Samples the posterior on an emulator of the model's outputs; it is told these.
    Emulated(Box<EmulatedSampler>),
    /// Fits the most probable parameters by steps, from predicted values.
    Fit(Box<LmFit>),
    /// Finds the most probable parameters by generations; it is told log-likelihoods.
    Evolution(Box<Evolution>),
    /// Searches for a missing effect; it is told predicted values.
    Discovery(Box<RunningDiscovery>),
    /// The engine takes a step on another thread.
    Stepping(Box<EngineOutline>),
}

/// The reason why a calibration cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum BeginError {
    /// The settings do not fit the prior.
    #[error("[sampler] {0}")]
    AlgorithmSettings(#[from] AlgorithmSettingsError),
    /// A model of the search cannot be made.
    #[error(transparent)]
    Search(#[from] DiscoveryError),
    /// A search for a missing effect was begun without its models.
    #[error("a search for a missing effect needs the texts of its job and experiment")]
    NoModels,
}

/// A result that an engine cannot take.
#[derive(Debug, thiserror::Error)]
pub(super) enum EngineError {
    /// The result does not belong to a pending proposal.
    #[error(transparent)]
    Tell(#[from] TellError),
    /// The next round of the search cannot be proposed.
    #[error(transparent)]
    Discovery(#[from] DiscoveryError),
    /// The log-likelihood of the result is not a number.
    #[error(transparent)]
    Score(#[from] NotANumber),
    /// The engine takes a step.
    #[error("a result came while the next round was being computed")]
    Stepping,
}

/// Returns ln p(data | theta) of an evaluation. Where the model rejected the parameters, the data are impossible.
pub(super) fn log_likelihood(row: &EvaluationRow) -> Result<LogLikelihood, NotANumber> {
    row.log_likelihood
        .map_or(Ok(LogLikelihood::Impossible), LogLikelihood::new)
}

/// The result of an engine.
#[derive(Debug, Clone)]
pub enum CalibrationResult<'a> {
    /// A sample of the posterior.
    Posterior(&'a PosteriorSample),
    /// The most probable parameters.
    Estimate(&'a ModeEstimate),
    /// The result of a search for a missing effect.
    Discovery(Box<Discovery>),
}

impl CalibrationEngine {
    /// Makes an engine whose first round is pending.
    ///
    /// # Arguments
    /// - `models`: the models of a search for a missing effect; `None` for other algorithms.
    ///
    /// # Errors
    /// [`BeginError`] where the settings do not fit the prior, or a search has no models.
    pub(super) fn new(spec: &Spec, models: Option<SearchModels>) -> Result<Self, BeginError> {
        let (prior, likelihood) = (spec.prior(), &spec.likelihood);
        Ok(match spec.algorithm {
            AlgorithmSettings::Sample(settings) if settings.is_emulated() => {
                let parameters = spec.fit_variant.parameters.len();
                let sampler = EmulatedSampler::new(prior, likelihood.clone(), settings, parameters);
                let sampler = sampler.map_err(AlgorithmSettingsError::from)?;
                CalibrationEngine::Emulated(Box::new(sampler))
            }
            AlgorithmSettings::Sample(settings) => {
                let sampler = Sampler::new(prior, settings).map_err(AlgorithmSettingsError::from)?;
                CalibrationEngine::Sampler(Box::new(sampler))
            }
            AlgorithmSettings::Fit(settings) => {
                let fit = LmFit::new(prior, likelihood.clone(), settings);
                CalibrationEngine::Fit(Box::new(fit.map_err(AlgorithmSettingsError::from)?))
            }
            AlgorithmSettings::Evolve(settings) => CalibrationEngine::Evolution(Box::new(
                Evolution::new(prior, settings).map_err(AlgorithmSettingsError::from)?,
            )),
            AlgorithmSettings::Discover { .. } => {
                let models = models.ok_or(BeginError::NoModels)?;
                CalibrationEngine::Discovery(Box::new(RunningDiscovery::new(models)?))
            }
        })
    }

    /// Returns the number of completed rounds.
    pub(super) fn round(&self) -> u64 {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.round().number(),
            CalibrationEngine::Emulated(sampler) => sampler.round().number(),
            CalibrationEngine::Fit(fit) => fit.round().number(),
            CalibrationEngine::Evolution(evolution) => evolution.round().number(),
            CalibrationEngine::Discovery(discovery) => discovery.round(),
            CalibrationEngine::Stepping(outline) => outline.round,
        }
    }

    /// Returns the proposals of this round, by ascending particle.
    pub(super) fn pending(&self) -> &[Proposal] {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.round().pending(),
            CalibrationEngine::Emulated(sampler) => sampler.round().pending(),
            CalibrationEngine::Fit(fit) => fit.round().pending(),
            CalibrationEngine::Evolution(evolution) => evolution.round().pending(),
            CalibrationEngine::Discovery(discovery) => discovery.pending(),
            CalibrationEngine::Stepping(_) => &[],
        }
    }

    /// Tells the engine the result of a pending particle.
    ///
    /// # Arguments
    /// - `values`: the predicted values that the row keeps; `None` where the model rejected, or nothing is kept.
    pub(super) fn tell(
        &mut self,
        particle: usize,
        row: &EvaluationRow,
        values: Option<&[f64]>,
    ) -> Result<TellProgress, EngineError> {
        Ok(match self {
            CalibrationEngine::Sampler(sampler) => sampler.tell(particle, log_likelihood(row)?)?,
            CalibrationEngine::Emulated(sampler) => sampler.tell(particle, values)?,
            CalibrationEngine::Fit(fit) => fit.tell(particle, values)?,
            CalibrationEngine::Evolution(evolution) => evolution.tell(particle, log_likelihood(row)?)?,
            CalibrationEngine::Discovery(discovery) if row.worker == NOBODY => discovery.give_up(particle)?,
            CalibrationEngine::Discovery(discovery) => discovery.tell(particle, values)?,
            CalibrationEngine::Stepping(_) => return Err(EngineError::Stepping),
        })
    }

    /// Returns whether the round in progress asks for draws that may be the posterior as they are.
    pub(super) fn asks_final_draws(&self) -> bool {
        match self {
            CalibrationEngine::Emulated(sampler) => sampler.asks_final_draws(),
            CalibrationEngine::Sampler(_)
            | CalibrationEngine::Fit(_)
            | CalibrationEngine::Evolution(_)
            | CalibrationEngine::Discovery(_)
            | CalibrationEngine::Stepping(_) => false,
        }
    }

    /// Returns the search for a missing effect, if the engine runs a search.
    pub(super) fn discovery(&self) -> Option<&RunningDiscovery> {
        match self {
            CalibrationEngine::Discovery(discovery) => Some(discovery),
            CalibrationEngine::Sampler(_)
            | CalibrationEngine::Emulated(_)
            | CalibrationEngine::Fit(_)
            | CalibrationEngine::Evolution(_)
            | CalibrationEngine::Stepping(_) => None,
        }
    }

    /// Returns what an emulated sampler found about its emulator.
    pub(super) fn emulator(&self) -> Option<&EmulatorRecord> {
        match self {
            CalibrationEngine::Emulated(sampler) => Some(sampler.record()),
            CalibrationEngine::Sampler(_)
            | CalibrationEngine::Fit(_)
            | CalibrationEngine::Evolution(_)
            | CalibrationEngine::Discovery(_)
            | CalibrationEngine::Stepping(_) => None,
        }
    }

    /// Returns the finished stages; only a sampler has any.
    pub fn stages(&self) -> &[StageRecord] {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.stages(),
            CalibrationEngine::Emulated(sampler) => sampler.stages(),
            CalibrationEngine::Fit(_)
            | CalibrationEngine::Evolution(_)
            | CalibrationEngine::Discovery(_)
            | CalibrationEngine::Stepping(_) => &[],
        }
    }

    /// Returns the result, once finished.
    pub fn finding(&self) -> Option<CalibrationResult<'_>> {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.posterior().map(CalibrationResult::Posterior),
            CalibrationEngine::Emulated(sampler) => sampler.posterior().map(CalibrationResult::Posterior),
            CalibrationEngine::Fit(fit) => fit.estimate().map(CalibrationResult::Estimate),
            CalibrationEngine::Evolution(evolution) => evolution.estimate().map(CalibrationResult::Estimate),
            CalibrationEngine::Discovery(discovery) => {
                let record = discovery.record();
                record.map(|record| CalibrationResult::Discovery(Box::new(record)))
            }
            CalibrationEngine::Stepping(_) => None,
        }
    }

    /// Returns what remains known of the engine during a step.
    pub(super) fn outline(&self) -> EngineOutline {
        EngineOutline {
            round: self.round(),
            position: self.position(),
            exponents: self.exponents(),
            search: self.search(),
        }
    }

    /// Returns how far the algorithm is.
    pub fn position(&self) -> Position {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler_position(sampler.progress()),
            CalibrationEngine::Emulated(sampler) => sampler_position(sampler.progress()),
            CalibrationEngine::Fit(fit) => Position::Fit {
                steps: fit.steps() as u32,
            },
            CalibrationEngine::Evolution(evolution) => Position::Evolution {
                generations: evolution.history().len() as u32,
            },
            CalibrationEngine::Discovery(search) => Position::Search {
                rounds: search.round() as u32,
            },
            CalibrationEngine::Stepping(outline) => outline.position,
        }
    }

    /// Returns the tempering exponents of the finished stages.
    pub fn exponents(&self) -> Vec<f64> {
        match self {
            CalibrationEngine::Stepping(outline) => outline.exponents.clone(),
            engine => engine.stages().iter().map(|s| s.tempering_exponent).collect(),
        }
    }

    /// Returns what a search is doing; `None` for other algorithms.
    pub fn search(&self) -> Option<SearchProgress> {
        match self {
            CalibrationEngine::Stepping(outline) => outline.search.clone(),
            engine => Some(engine.discovery()?.progress()),
        }
    }
}

fn sampler_position(now: StageProgress) -> Position {
    Position::Sampler {
        stage: now.stage as u32,
        tempering_exponent: now.tempering_exponent,
        step: now.step as u32,
        acceptance: now.acceptance,
    }
}
