//! How a search for one effect is asked and told: its constructors, the requests of a round, and the answers, which select the
//! next phase.

use crate::candidate::{Candidate, CandidateError};
use crate::effect_search::base;
use crate::effect_search::change::CandidateChange;
use crate::effect_search::depth::Depth;
use crate::effect_search::ranking::EffectRanking;
use crate::effect_search::state::{EffectSearch, FitPhase, Phase};
use crate::laplace::batch::{FitBatch, PositionRequest};
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::FittedModel;
use crate::settings::{SearchSettings, Starts};
use inference::{InferenceFailure, TellError, TellProgress};
use statistics::likelihood::Likelihood;
use statistics::prior::Prior;

/// A parameter vector to evaluate.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectRequest {
    /// The candidate that is switched on; `None`: the base model.
    pub candidate: Option<usize>,
    /// Whether the low-fidelity model is asked, in place of the model.
    pub is_low_fidelity: bool,
    /// The base's parameters, then the candidate's.
    pub theta: Vec<f64>,
}

impl EffectSearch {
    /// Makes a search whose first round holds the starts of the base's fit.
    ///
    /// # Arguments
    /// - `prior`: the prior of the base's parameters, which include inferred noise sds. `likelihood`: the data.
    ///
    /// # Errors
    /// [`CandidateError`] if the base has no parameter or a candidate is ill-defined.
    pub fn new(
        prior: &Prior,
        likelihood: Likelihood,
        candidates: &[Candidate],
        settings: &SearchSettings,
    ) -> Result<Self, CandidateError> {
        if prior.dimension() == 0 {
            return Err(CandidateError::NoBase);
        }
        candidates.iter().try_for_each(Candidate::check)?;
        let frame =
            NormalFrame::base(prior, settings.smoothness).with_low_fidelity(settings.has_low_fidelity);
        let positions = match &settings.starts {
            Starts::Draws(draws) => draws.iter().map(|theta| frame.position(theta)).collect(),
            Starts::Even(count) => base::starts(&frame, *count),
        };
        let mut search = Self::unasked(frame, likelihood, candidates, settings.seed);
        search.measures_noise = settings.has_numerical_noise;
        search.depth = Depth::for_smoothness(settings.smoothness);
        search.ask(PositionRequest::all_for_model(None, positions).collect());
        Ok(search)
    }

    /// Makes a search that extends a model that is fitted already. Without candidates it is done at once.
    ///
    /// # Arguments
    /// - `changes`: what the candidates changed beyond another base, which selects those that are screened on the model.
    pub(crate) fn beyond(
        base: FittedModel,
        likelihood: Likelihood,
        candidates: (&[Candidate], &[Option<CandidateChange>]),
        depth: &'static Depth,
        seed: u64,
    ) -> Self {
        let (candidates, changes) = candidates;
        let mut search = Self::unasked(base.fit.frame.clone(), likelihood, candidates, seed);
        search.depth = depth;
        search.base = Some(base);
        search.screen_by_changes(changes);
        search.screen_low_fidelity();
        search
    }

    /// Makes a fit of one model from the best of these starts, without candidates.
    pub(crate) fn refit(
        frame: NormalFrame,
        starts: Vec<Vec<f64>>,
        likelihood: Likelihood,
        seed: u64,
    ) -> Self {
        let mut search = Self::unasked(frame, likelihood, &[], seed);
        search.ask(PositionRequest::all_for_model(None, starts).collect());
        search
    }

    /// Returns the requests of this round; the position of one is its index.
    pub fn pending(&self) -> impl Iterator<Item = EffectRequest> {
        let pairs = self.requests.iter().zip(self.round.pending());
        pairs.map(|(request, proposal)| EffectRequest {
            candidate: request.candidate,
            is_low_fidelity: request.is_low_fidelity,
            theta: proposal.theta.clone(),
        })
    }

    /// Takes the predicted values of a request; the last one of a round advances the search.
    ///
    /// # Arguments
    /// - `values`: as [`Likelihood::log_likelihood`] takes them; `None` where the model rejected the parameters.
    ///
    /// # Errors
    /// [`TellError`] for an answer that was told before or never asked for, or with a wrong number of values or infinite ones. The
    /// search is unchanged then.
    pub fn tell(&mut self, index: usize, values: Option<&[f64]>) -> Result<TellProgress, TellError> {
        if let Some(values) = values {
            let (expected, given) = (self.likelihood.values(), values.len());
            if expected != given {
                return Err(TellError::Length { expected, given });
            }
            self.likelihood.check_values(values)?;
        }
        let complete = self.round.tell(index, values.map(<[f64]>::to_vec))?;
        if complete {
            let (_, answers) = self.round.complete();
            self.advance(answers);
        }
        Ok(match &self.phase {
            Phase::Done(_) => TellProgress::Finished,
            Phase::Failed(failure) => TellProgress::Failed(*failure),
            _ if complete => TellProgress::NextRound,
            _ => TellProgress::Waiting,
        })
    }

    /// Takes the answers of a round and begins the next.
    fn advance(&mut self, answers: Vec<Option<Vec<f64>>>) {
        match std::mem::replace(&mut self.phase, Phase::BaseStarts) {
            Phase::BaseStarts => self.take_base_starts(answers),
            Phase::NumericalNoise(batch, spacing) => self.take_noise(batch, spacing, &answers),
            Phase::LowFidelityScreen => self.take_low_fidelity_screen(answers),
            Phase::Screen(level) => self.take_screen(level, answers),
            Phase::ReducedDiscrepancy(likelihood, mut batch) => {
                batch.tell(&likelihood, answers);
                self.fit_reduced_discrepancy(likelihood, batch);
            }
            Phase::Fits(phase, mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.fit(phase, batch);
            }
            Phase::ConfirmationStarts(candidates) => self.take_confirmation_starts(candidates, answers),
            Phase::Sampling(models, counts) => self.take_sample(models, &counts, answers),
            over @ (Phase::Done(_) | Phase::Failed(_)) => self.phase = over,
        }
    }

    /// Asks for the next evaluations of a batch of fits; once they are complete, begins what follows them.
    pub(super) fn fit(&mut self, phase: FitPhase, mut batch: FitBatch) {
        let requests = batch.ask(&self.likelihood);
        if !requests.is_empty() {
            self.ask(requests);
            self.phase = Phase::Fits(phase, batch);
            return;
        }
        match phase {
            FitPhase::Base => self.take_base_fits(batch),
            FitPhase::Extensions => self.take_extensions(batch),
            FitPhase::WithinReach => self.take_within_reach(batch),
            FitPhase::Refinement => self.take_refinement(batch),
            FitPhase::Confirmation => self.take_confirmation(batch),
        }
    }

    /// Returns why the search failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        match self.phase {
            Phase::Failed(failure) => Some(failure),
            _ => None,
        }
    }

    /// Returns the result; `None` while the search is running, and where it failed.
    #[must_use]
    pub fn ranking(&self) -> Option<&EffectRanking> {
        match &self.phase {
            Phase::Done(ranking) => Some(ranking),
            _ => None,
        }
    }
}
