//! The state of a search for one effect: its model, its candidates with their results, and the phase that it is in.

use std::collections::BTreeMap;

use crate::candidate::Candidate;
use crate::effect_search::depth::{Depth, FULL};
use crate::effect_search::ranking::{EffectRanking, EvaluationCounts, EvidenceMethod};
use crate::effect_search::screen_result::Screened;
use crate::laplace::batch::{FitBatch, PositionRequest};
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::{FittedModel, LaplaceFit};
use crate::laplace::importance::ImportanceSampler;
use crate::settings::Smoothness;
use inference::{InferenceFailure, Proposal, ProposalRound};
use statistics::likelihood::Likelihood;

/// An ask/tell search for one missing effect.
///
/// Its state is a function of priors, likelihood, candidates, settings and the told values, whatever their order within a round.
#[derive(Debug, Clone)]
pub struct EffectSearch {
    pub(crate) likelihood: Likelihood,
    pub(super) base_frame: NormalFrame,
    pub(super) candidates: Vec<CandidateState>,
    pub(super) round: ProposalRound<Option<Vec<f64>>>,
    /// The requests of the round.
    pub(super) requests: Vec<PositionRequest>,
    pub(super) phase: Phase,
    pub(super) seed: u64,
    pub(super) depth: &'static Depth,
    pub(super) base: Option<FittedModel>,
    /// Whether the numerical noise is to be measured.
    pub(super) measures_noise: bool,
    /// Numerical noise sd of each channel, in its unit; empty where it is negligible.
    pub(crate) numerical_noise_sds: Vec<f64>,
    /// Whether fits that got stuck have been confirmed.
    pub(super) has_confirmed_stuck: bool,
    /// The candidates that were the best when members of their class were confirmed.
    pub(super) compared_best: Vec<usize>,
    /// Log evidence of the sampled models; `None` where the sampling failed.
    pub(super) sampled: BTreeMap<Option<usize>, Option<f64>>,
    pub(super) evaluations: EvaluationCounts,
}

/// The results of a candidate so far.
#[derive(Debug, Clone)]
pub(super) struct CandidateState {
    /// The coordinates of the base with this candidate added.
    pub(super) frame: NormalFrame,
    /// The candidate whose parameter has its limit here.
    pub(super) limit_of: Option<usize>,
    /// The result of the screen, on the model if that was evaluated.
    pub(super) screened: Option<Screened>,
    /// The result of a screen without the model: on the low-fidelity model, or by the change beyond another base.
    pub(super) low_fidelity: Option<Screened>,
    pub(super) is_screened_on_model: bool,
    pub(super) estimate: Option<EvidenceEstimate>,
    /// Whether a fit with the base has begun.
    pub(super) had_extension: bool,
    /// Whether it was fitted from several starts, or the model refused all of them.
    pub(super) had_confirmation: bool,
    /// Evaluations spent on it alone.
    pub(super) evaluations: usize,
}

/// The latest evidence for a candidate.
#[derive(Debug, Clone)]
pub(super) struct EvidenceEstimate {
    pub(super) log_bayes_factor: f64,
    /// The log Bayes factor with the stated prior of the strength.
    pub(super) stated_log_bayes_factor: f64,
    pub(super) method: EvidenceMethod,
    pub(super) fit: Option<LaplaceFit>,
}

/// A phase of fits with the likelihood of the search.
#[derive(Debug, Clone, Copy)]
pub(super) enum FitPhase {
    Base,
    /// The best candidates of the screen.
    Extensions,
    /// Further candidates, within reach of the best.
    WithinReach,
    Refinement,
    Confirmation,
}

/// The round that the search waits for.
#[derive(Debug, Clone)]
pub(super) enum Phase {
    /// The starts of the base's fits are evaluated.
    BaseStarts,
    Fits(FitPhase, FitBatch),
    /// Holds the base's fits, and the distance of neighbouring positions on the line through the best of them.
    NumericalNoise(FitBatch, f64),
    LowFidelityScreen,
    /// Holds the index of the strengths in [`STEPS`](crate::effect_search::screen::STEPS).
    Screen(usize),
    /// Holds the likelihood with the reduced discrepancy.
    ReducedDiscrepancy(Likelihood, FitBatch),
    /// Holds the candidates to confirm.
    ConfirmationStarts(Vec<usize>),
    /// Holds a sampler for each model, and how many draws each waits for.
    Sampling(Vec<(Option<usize>, ImportanceSampler)>, Vec<usize>),
    Done(Box<EffectRanking>),
    Failed(InferenceFailure),
}

impl CandidateState {
    /// Returns whether the model refused it at every step of the screen or from all starts, or it has no evidence: the result of
    /// its screen is void then. This holds for all candidates before the screen.
    pub(super) fn is_refused(&self) -> bool {
        let has_fit = self
            .estimate
            .as_ref()
            .is_some_and(|estimate| estimate.fit.is_some());
        self.screened.is_none() || (self.had_confirmation && !has_fit)
    }
}

impl EffectSearch {
    /// Makes a search without a pending round.
    pub(super) fn unasked(
        base_frame: NormalFrame,
        likelihood: Likelihood,
        candidates: &[Candidate],
        seed: u64,
    ) -> Self {
        let place = |name: &String| candidates.iter().position(|other| other.name == *name);
        let candidates = candidates.iter().map(|candidate| CandidateState {
            frame: base_frame.with(candidate),
            limit_of: candidate.limit_of.as_ref().and_then(place),
            screened: None,
            low_fidelity: None,
            is_screened_on_model: false,
            estimate: None,
            had_extension: false,
            had_confirmation: false,
            evaluations: 0,
        });
        Self {
            likelihood,
            candidates: candidates.collect(),
            base_frame,
            round: ProposalRound::default(),
            requests: Vec::new(),
            phase: Phase::BaseStarts,
            seed,
            depth: &FULL,
            base: None,
            measures_noise: false,
            numerical_noise_sds: Vec::new(),
            has_confirmed_stuck: false,
            compared_best: Vec::new(),
            sampled: BTreeMap::new(),
            evaluations: EvaluationCounts::default(),
        }
    }

    /// Continues the search at the depth of this smoothness.
    pub(super) fn set_smoothness(&mut self, smoothness: Smoothness) {
        self.depth = Depth::for_smoothness(smoothness);
        self.base_frame.smoothness = smoothness;
        for candidate in &mut self.candidates {
            candidate.frame.smoothness = smoothness;
        }
    }

    /// Returns the smoothness of the model, if it is known.
    pub(crate) fn smoothness(&self) -> Smoothness {
        self.base_frame.smoothness
    }

    /// Returns the fit of the base, once there is one.
    pub(crate) fn base_fit(&self) -> Option<&FittedModel> {
        self.base.as_ref()
    }

    /// Returns the best fit of a candidate so far.
    pub(crate) fn fit_of(&self, candidate: usize) -> Option<&LaplaceFit> {
        self.candidates[candidate].estimate.as_ref()?.fit.as_ref()
    }

    /// Returns the log Bayes factor of a candidate so far.
    pub(crate) fn log_bayes_factor_of(&self, candidate: usize) -> Option<f64> {
        let estimate = self.candidates[candidate].estimate.as_ref();
        estimate.map(|estimate| estimate.log_bayes_factor)
    }

    pub(super) fn frame(&self, candidate: Option<usize>) -> &NormalFrame {
        candidate.map_or(&self.base_frame, |k| &self.candidates[k].frame)
    }

    /// Begins a round.
    pub(super) fn ask(&mut self, requests: Vec<PositionRequest>) {
        let of_model = requests.iter().filter(|request| !request.is_low_fidelity);
        for candidate in of_model.filter_map(|request| request.candidate) {
            self.candidates[candidate].evaluations += 1;
        }
        let proposals = requests.iter().enumerate().map(|(index, request)| {
            Proposal::new(index, self.frame(request.candidate).theta(&request.position))
        });
        let proposals = proposals.collect();
        self.round.ask(proposals);
        self.requests = requests;
    }
}
