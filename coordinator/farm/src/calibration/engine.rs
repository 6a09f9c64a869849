//! The sampler, fit, evolution or discovery of a calibration: what asks for evaluations and is told their results.

use inference::evolution::Evolution;
use inference::lm::LmFit;
use inference::point_estimate::ModeEstimate;
use inference::{EvaluationResult, PosteriorSample, Proposal, Sampler, StageRecord, TellError, TellProgress};
use statistics::{LogLikelihood, Metamodel, ModelPair, NotANumber};

use job::{AlgorithmSettings, AlgorithmSettingsError, Spec};
use record::{Discovery, EvaluationRow};
use search::{DiscoveryError, RunningDiscovery, SearchModels};

/// What asks for evaluations and is told their results.
#[derive(Debug)]
pub enum CalibrationEngine {
    /// Samples the posterior; told log-likelihoods.
    Sampler(Box<Sampler>),
    /// Fits the most probable parameters by steps; told predicted values.
    Fit(Box<LmFit>),
    /// Finds the most probable parameters by generations; told log-likelihoods.
    Evolution(Box<Evolution>),
    /// Searches for what the model is missing; told predicted values.
    Discovery(Box<RunningDiscovery>),
}

/// Why a calibration cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum BeginError {
    /// The settings do not fit the prior.
    #[error("[sampler] {0}")]
    AlgorithmSettings(#[from] AlgorithmSettingsError),
    /// The search has a model that cannot be made.
    #[error(transparent)]
    Search(#[from] DiscoveryError),
    /// A search for a missing effect needs the models that it asks.
    #[error("a search for a missing effect needs the texts of its job and experiment")]
    NoModels,
}

/// A result that an engine cannot take.
#[derive(Debug, thiserror::Error)]
pub(super) enum EngineError {
    /// It answers nothing that was asked.
    #[error(transparent)]
    Tell(#[from] TellError),
    /// What follows cannot be asked.
    #[error(transparent)]
    Discovery(#[from] DiscoveryError),
    /// Its log-likelihood is no number.
    #[error(transparent)]
    Score(#[from] NotANumber),
}

/// What a sampler is told of an evaluation.
fn sampled(row: &EvaluationRow) -> Result<EvaluationResult, NotANumber> {
    let log_likelihood = log_likelihood(row)?;
    let pair = row.kept.fitted().zip(row.coarse.as_ref());
    let pair = pair.map(|(fine, coarse)| ModelPair {
        fine: fine.to_vec(),
        coarse: coarse.clone(),
    });
    Ok(match &row.end {
        None => EvaluationResult::AtProposal { log_likelihood, pair },
        Some(end) => EvaluationResult::AtSubchainEnd {
            found: (end.accepted > 0).then_some((log_likelihood, pair)),
            end: end.clone(),
        },
    })
}

/// ln p(data | theta) at the parameters that were asked for; where the model refused, the data are impossible.
pub(super) fn log_likelihood(row: &EvaluationRow) -> Result<LogLikelihood, NotANumber> {
    row.log_likelihood
        .map_or(Ok(LogLikelihood::Impossible), LogLikelihood::new)
}

/// What an engine ends with.
#[derive(Debug, Clone)]
pub enum CalibrationResult<'a> {
    /// A sample of the posterior.
    Posterior(&'a PosteriorSample),
    /// The most probable parameters.
    Estimate(&'a ModeEstimate),
    /// What the model is missing.
    Discovery(Box<Discovery>),
}

impl CalibrationEngine {
    /// An engine whose first round is pending.
    ///
    /// # Arguments
    /// - `models`: what a search for a missing effect asks; nothing else needs them.
    ///
    /// # Errors
    /// [`BeginError`] where the settings do not fit the prior, or a search has no models.
    pub(super) fn new(spec: &Spec, models: Option<SearchModels>) -> Result<Self, BeginError> {
        let (prior, likelihood) = (spec.prior(), &spec.likelihood);
        Ok(match spec.algorithm {
            AlgorithmSettings::Sample(settings) => {
                let sampler = Sampler::with_metamodel(prior, settings, likelihood.clone());
                let sampler = sampler.map_err(AlgorithmSettingsError::from)?;
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

    /// Number of completed rounds.
    pub(super) fn round(&self) -> u64 {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.round().number(),
            CalibrationEngine::Fit(fit) => fit.round().number(),
            CalibrationEngine::Evolution(evolution) => evolution.round().number(),
            CalibrationEngine::Discovery(discovery) => discovery.round(),
        }
    }

    /// This round's proposals, by ascending particle.
    pub(super) fn pending(&self) -> &[Proposal] {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.round().pending(),
            CalibrationEngine::Fit(fit) => fit.round().pending(),
            CalibrationEngine::Evolution(evolution) => evolution.round().pending(),
            CalibrationEngine::Discovery(discovery) => discovery.pending(),
        }
    }

    /// Takes the result of a pending particle: log-likelihood and the kept values.
    pub(super) fn tell(&mut self, particle: usize, row: &EvaluationRow) -> Result<TellProgress, EngineError> {
        Ok(match self {
            CalibrationEngine::Sampler(sampler) => sampler.tell(particle, sampled(row)?)?,
            CalibrationEngine::Fit(fit) => fit.tell(particle, row.kept.fitted())?,
            CalibrationEngine::Evolution(evolution) => evolution.tell(particle, log_likelihood(row)?)?,
            CalibrationEngine::Discovery(discovery) => discovery.tell(particle, row.kept.fitted())?,
        })
    }

    /// The search for a missing effect, if this is one.
    pub(super) fn discovery(&self) -> Option<&RunningDiscovery> {
        match self {
            CalibrationEngine::Discovery(discovery) => Some(discovery),
            CalibrationEngine::Sampler(_) | CalibrationEngine::Fit(_) | CalibrationEngine::Evolution(_) => {
                None
            }
        }
    }

    /// What takes the subchains of the stage in progress, if anything does.
    pub(super) fn metamodel(&self) -> Option<&Metamodel> {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.metamodel(),
            CalibrationEngine::Fit(_) | CalibrationEngine::Evolution(_) | CalibrationEngine::Discovery(_) => {
                None
            }
        }
    }

    /// The finished stages; only a sampler has any.
    pub fn stages(&self) -> &[StageRecord] {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.stages(),
            CalibrationEngine::Fit(_) | CalibrationEngine::Evolution(_) | CalibrationEngine::Discovery(_) => {
                &[]
            }
        }
    }

    /// The result, once finished.
    pub fn finding(&self) -> Option<CalibrationResult<'_>> {
        match self {
            CalibrationEngine::Sampler(sampler) => sampler.posterior().map(CalibrationResult::Posterior),
            CalibrationEngine::Fit(fit) => fit.estimate().map(CalibrationResult::Estimate),
            CalibrationEngine::Evolution(evolution) => evolution.estimate().map(CalibrationResult::Estimate),
            CalibrationEngine::Discovery(discovery) => {
                let record = discovery.record();
                record.map(|record| CalibrationResult::Discovery(Box::new(record)))
            }
        }
    }
}
