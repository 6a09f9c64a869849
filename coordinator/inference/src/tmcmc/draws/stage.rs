//! A stage of independent draws in progress.

use std::sync::Arc;

use statistics::log_likelihood::LogLikelihood;
use statistics::metamodel::{ChainState, Pool};
use statistics::prior::Prior;

use super::proposal::{Draw, DrawKey, DrawProposal};
use super::sample::{Expectation, ImportanceWeights, WeightedSample};
use crate::mixture::{Mixture, WeightedPoints, fitted};
use crate::round::Proposal;
use crate::tmcmc::evaluation::EvaluationResult;
use crate::tmcmc::settings::TmcmcSettings;

/// Effective share of the draws below which a proposal has missed its target.
const LEAST_SHARE: f64 = 0.05;

/// The same at exponent 1, where every further draw is one of the posterior.
const LEAST_SHARE_OF_POSTERIOR: f64 = 0.25;

/// Proposals that miss one target before the stage falls back to moves.
const ATTEMPTS: usize = 3;

/// Refits at exponent 1 for a better share, once a proposal has not missed.
const REFINEMENTS: usize = 4;

/// Effective draws of the posterior, for each particle of the population.
const EFFECTIVE_DRAWS: f64 = 2.0;

/// Most draws of the posterior, for each particle of the population.
const MOST_DRAWS: usize = 20;

/// Weight moved from heavy to light components of a fit.
const LEVELLED: f64 = 0.3;

/// Share of the draws that come from the fit of the exponent before, which is wider.
const DEFENSIVE: f64 = 0.1;

/// Where the stage began: an equally weighted sample of the stage before, and its evidence.
#[derive(Debug, Clone)]
pub(crate) struct Anchor {
    pub(crate) pool: Pool,
    pub(crate) exponent: f64,
    pub(crate) log_evidence: f64,
    pub(crate) variance: f64,
    /// The surviving fraction of the prior draws, where these are the anchor: survivors and draws.
    pub(crate) survivors: Option<[usize; 2]>,
}

/// What the draws of the stage before say about this stage's target.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Forecast {
    pub(crate) log_likelihood: Expectation,
    pub(crate) log_evidence: f64,
    pub(crate) log_evidence_variance: f64,
}

impl Forecast {
    pub(crate) fn new(sample: &WeightedSample, weights: &ImportanceWeights) -> Self {
        Self {
            log_likelihood: sample.mean_log_likelihood(weights),
            log_evidence: weights.log_mean,
            log_evidence_variance: weights.log_mean_variance(),
        }
    }
}

/// What a completed round of draws means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Standing {
    /// The draws represent their target.
    Done,
    /// The same proposal gives this many draws more.
    More(usize),
    /// A better fit is worth its draws, or these have missed their target.
    Refit,
    /// No proposal reached the target.
    Missed,
}

/// A stage of independent draws.
#[derive(Debug, Clone)]
pub(crate) struct DrawStage {
    pub(crate) index: usize,
    pub(crate) exponent: f64,
    pub(crate) anchor: Arc<Anchor>,
    pub(crate) forecast: Forecast,
    /// The draws so far of the proposal in use.
    pub(crate) sample: WeightedSample,
    pub(crate) proposal: DrawProposal,
    /// The fit of this stage's target; the next stage's defence.
    pub(crate) fit: Mixture,
    /// The fit of the exponent before.
    before: Option<Mixture>,
    /// Draws that wait for their evaluation.
    pending: Vec<Draw>,
    /// How many to ask for next.
    wanted: usize,
    attempts: usize,
    missed: usize,
    pub(crate) rounds: usize,
    pub(crate) evaluations: u64,
}

/// What a stage begins with.
pub(crate) struct DrawStart<'a> {
    pub(crate) index: usize,
    pub(crate) exponent: f64,
    pub(crate) anchor: Arc<Anchor>,
    /// Draws whose weights at `exponent` stand for its target.
    pub(crate) sample: &'a WeightedSample,
    pub(crate) weights: &'a ImportanceWeights,
    pub(crate) before: Option<Mixture>,
}

impl DrawStage {
    /// Fits a proposal to weighted draws. `None` if there is none: the draws do not span the space.
    pub(crate) fn new(start: DrawStart, prior: &Prior, settings: &TmcmcSettings) -> Option<Self> {
        let DrawStart {
            index,
            exponent,
            anchor,
            sample,
            weights,
            before,
        } = start;
        let key = DrawKey {
            seed: settings.seed,
            stage: index,
            attempt: 0,
        };
        let (fit, proposal) = propose(
            (sample, weights),
            before.as_ref(),
            (exponent, key),
            prior,
            settings,
        )?;
        Some(Self {
            index,
            exponent,
            anchor,
            forecast: Forecast::new(sample, weights),
            sample: WeightedSample::default(),
            proposal,
            fit,
            before,
            pending: Vec::new(),
            wanted: settings.particles,
            attempts: 0,
            missed: 0,
            rounds: 0,
            evaluations: 0,
        })
    }

    /// Draws the next round.
    pub(crate) fn propose(&mut self, prior: &Prior) -> Vec<Proposal> {
        self.pending = self.proposal.draws(self.wanted, prior);
        let draws = self.pending.iter().enumerate();
        draws
            .map(|(index, draw)| Proposal::plain(index, prior.theta(&draw.coordinates)))
            .collect()
    }

    /// Takes the results of the round, in the order of its draws.
    pub(crate) fn accept(&mut self, results: Vec<EvaluationResult>) {
        self.rounds += 1;
        for (draw, result) in self.pending.drain(..).zip(results) {
            self.evaluations += 1;
            let log_likelihood = match result {
                EvaluationResult::AtProposal { log_likelihood, .. } => log_likelihood,
                // `Sampler::tell` refuses a subchain that was not asked for.
                EvaluationResult::AtSubchainEnd { .. } => LogLikelihood::Impossible,
            };
            let state = ChainState {
                coordinates: draw.coordinates,
                log_prior: draw.log_prior,
                log_likelihood,
                pair: None,
            };
            self.sample.push(state, draw.log_ratio);
        }
    }

    /// What the draws so far mean; `weights` are theirs at this stage's exponent.
    pub(crate) fn standing(&self, weights: Option<&ImportanceWeights>, particles: usize) -> Standing {
        let drawn = self.sample.states.len();
        let Some(weights) = weights.filter(|weights| !is_poor(weights, &self.sample)) else {
            return if self.missed + 1 < ATTEMPTS {
                Standing::Refit
            } else {
                Standing::Missed
            };
        };
        if self.exponent < 1.0 {
            return Standing::Done;
        }
        if weights.share() < LEAST_SHARE_OF_POSTERIOR && self.attempts < REFINEMENTS {
            return Standing::Refit;
        }
        let (goal, most) = (EFFECTIVE_DRAWS * particles as f64, MOST_DRAWS * particles);
        if weights.ess >= goal || drawn >= most {
            return Standing::Done;
        }
        let total = (goal / weights.share()).ceil().min(most as f64) as usize;
        // No round has more proposals than there are particles.
        Standing::More(total.saturating_sub(drawn).clamp(1, particles))
    }

    /// Asks the same proposal for more.
    pub(crate) fn ask_more(&mut self, count: usize) {
        self.wanted = count;
    }

    /// Replaces the proposal by a fit to the draws so far, which are then dropped. False if there is no fit.
    pub(crate) fn refit(&mut self, prior: &Prior, settings: &TmcmcSettings) -> bool {
        let Some(weights) = self.sample.weights(self.exponent) else {
            return false;
        };
        self.attempts += 1;
        self.missed += usize::from(is_poor(&weights, &self.sample));
        let key = DrawKey {
            seed: settings.seed,
            stage: self.index,
            attempt: self.attempts,
        };
        let target = (self.exponent, key);
        let Some((fit, proposal)) = propose(
            (&self.sample, &weights),
            self.before.as_ref(),
            target,
            prior,
            settings,
        ) else {
            return false;
        };
        (self.fit, self.proposal) = (fit, proposal);
        self.sample = WeightedSample::default();
        self.wanted = settings.particles;
        true
    }
}

/// Whether draws have missed their target.
fn is_poor(weights: &ImportanceWeights, sample: &WeightedSample) -> bool {
    let dimension = sample.states.first().map_or(0, |state| state.coordinates.len());
    weights.share() < LEAST_SHARE || weights.ess < 2.0 * (dimension as f64 + 1.0)
}

/// A fit to weighted draws, and what to draw from: the fit, levelled, with a share of the one before.
fn propose(
    (sample, weights): (&WeightedSample, &ImportanceWeights),
    before: Option<&Mixture>,
    (exponent, key): (f64, DrawKey),
    prior: &Prior,
    settings: &TmcmcSettings,
) -> Option<(Mixture, DrawProposal)> {
    let coordinates = sample
        .states
        .iter()
        .flat_map(|state| state.coordinates.iter().copied());
    let points = WeightedPoints::new(
        prior.dimension(),
        coordinates.collect(),
        weights.normalised.clone(),
    );
    let fit = fitted(&points, settings.components, &mut key.fit())?.levelled(LEVELLED);
    let mixture = before.map_or_else(|| fit.clone(), |before| fit.with(before, DEFENSIVE));
    let proposal = DrawProposal::new(mixture, prior, key, settings.particles, exponent >= 1.0)?;
    Some((fit, proposal))
}
