//! The sampler, fit or search of a calibration: what asks for evaluations and is told their results.

use inference::lm::Optimiser;
use inference::point::Estimate;
use inference::search::Search;
use inference::{
    Answer, Likelihood, LogLikelihood, Metamodel, Pair, Posterior, Prior, Progress, Proposal, Sampler,
    StageRecord, SubchainEnd, TellError,
};

use crate::spec::{Method, MethodError};

/// What asks for evaluations and is told their results.
#[derive(Debug)]
pub enum Engine {
    /// Samples the posterior; told log-likelihoods.
    Sampler(Box<Sampler>),
    /// Fits the most probable parameters by steps; told predicted values.
    Fit(Box<Optimiser>),
    /// Searches the most probable parameters by generations; told log-likelihoods.
    Search(Box<Search>),
}

/// The result of an evaluation, scored.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scored<'a> {
    /// ln p(data | theta) at the parameters that were asked for.
    pub log_likelihood: LogLikelihood,
    /// The predicted values that the likelihood takes; `None` where the model refused.
    pub fitted: Option<&'a [f64]>,
    /// The same of the quasi-static model, where it was asked.
    pub coarse: Option<&'a [f64]>,
    /// Where the subchain ended that was asked for.
    pub end: Option<&'a SubchainEnd>,
}

impl Scored<'_> {
    /// What a sampler is told.
    fn answer(&self) -> Answer {
        let log_likelihood = self.log_likelihood;
        let pair = self.fitted.zip(self.coarse).map(|(fine, coarse)| Pair {
            fine: fine.to_vec(),
            coarse: coarse.to_vec(),
        });
        match self.end {
            None => Answer::Here { log_likelihood, pair },
            Some(end) => Answer::Moved {
                found: (end.accepted > 0).then_some((log_likelihood, pair)),
                end: end.clone(),
            },
        }
    }
}

/// What an engine ends with.
#[derive(Debug, Clone, Copy)]
pub enum Finding<'a> {
    /// A sample of the posterior.
    Posterior(&'a Posterior),
    /// The most probable parameters.
    Estimate(&'a Estimate),
}

impl Engine {
    /// An engine whose first round is pending.
    ///
    /// # Errors
    /// [`MethodError`] where the settings do not fit the prior.
    pub(super) fn new(prior: Prior, likelihood: &Likelihood, method: Method) -> Result<Self, MethodError> {
        Ok(match method {
            Method::Sample(settings) => {
                let sampler = Sampler::with_metamodel(prior, settings, likelihood.clone())?;
                Engine::Sampler(Box::new(sampler))
            }
            Method::Fit(settings) => {
                Engine::Fit(Box::new(Optimiser::new(prior, likelihood.clone(), settings)?))
            }
            Method::Search(settings) => Engine::Search(Box::new(Search::new(prior, settings)?)),
        })
    }

    /// Number of completed rounds.
    pub(super) fn round(&self) -> u64 {
        match self {
            Engine::Sampler(sampler) => sampler.round(),
            Engine::Fit(fit) => fit.round(),
            Engine::Search(search) => search.round(),
        }
    }

    /// This round's proposals, by ascending particle.
    pub(super) fn pending(&self) -> &[Proposal] {
        match self {
            Engine::Sampler(sampler) => sampler.pending(),
            Engine::Fit(fit) => fit.pending(),
            Engine::Search(search) => search.pending(),
        }
    }

    /// Takes the result of a pending particle.
    pub(super) fn tell(&mut self, particle: usize, scored: Scored) -> Result<Progress, TellError> {
        match self {
            Engine::Sampler(sampler) => sampler.tell(particle, scored.answer()),
            Engine::Fit(fit) => fit.tell(particle, scored.fitted),
            Engine::Search(search) => search.tell(particle, scored.log_likelihood),
        }
    }

    /// What takes the subchains of the stage in progress, if anything does.
    pub(super) fn metamodel(&self) -> Option<&Metamodel> {
        match self {
            Engine::Sampler(sampler) => sampler.metamodel(),
            Engine::Fit(_) | Engine::Search(_) => None,
        }
    }

    /// The finished stages; a fit and a search have none.
    pub fn stages(&self) -> &[StageRecord] {
        match self {
            Engine::Sampler(sampler) => sampler.stages(),
            Engine::Fit(_) | Engine::Search(_) => &[],
        }
    }

    /// The result, once finished.
    pub fn finding(&self) -> Option<Finding<'_>> {
        match self {
            Engine::Sampler(sampler) => sampler.posterior().map(Finding::Posterior),
            Engine::Fit(fit) => fit.estimate().map(Finding::Estimate),
            Engine::Search(search) => search.estimate().map(Finding::Estimate),
        }
    }
}
