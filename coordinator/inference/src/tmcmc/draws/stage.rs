//! A stage of independent draws in progress.

use statistics::log_likelihood::LogLikelihood;
use statistics::metamodel::{ChainState, Pool};
use statistics::prior::Prior;

use super::frame::Fit;
use super::proposal::{Draw, DrawKey, DrawProposal};
use super::sample::{Expectation, ImportanceWeights, WeightedSample};
use crate::round::Proposal;
use crate::tmcmc::evaluation::EvaluationResult;
use crate::tmcmc::settings::TmcmcSettings;

/// Effective share of the draws below which a proposal has missed its target.
const LEAST_SHARE: f64 = 0.05;

/// The same at exponent 1, where every further draw is one of the posterior.
const LEAST_SHARE_OF_POSTERIOR: f64 = 0.25;

/// Proposals in a row that may miss their targets before the stage falls back to moves.
const MISSES: usize = 6;

/// Part of the step of the exponent that remains after a miss.
const RETREAT: f64 = 0.3;

/// Refits at exponent 1 for a better share, once a proposal has not missed.
const REFINEMENTS: usize = 4;

/// Effective draws of the posterior, for each particle of the population.
const EFFECTIVE_DRAWS: f64 = 2.0;

/// Most draws of the posterior, for each particle of the population.
const MOST_DRAWS: usize = 20;

/// Weight moved from heavy to light components of a fit.
const LEVELLED: f64 = 0.4;

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
    /// A better fit is worth its draws.
    Refit,
    /// The draws have missed their target: a shorter step may reach it.
    Retreat,
    /// No proposal reached its target.
    Missed,
}

/// What a stage begins with.
#[derive(Debug, Clone)]
pub(crate) struct DrawStart {
    pub(crate) index: usize,
    pub(crate) anchor: Anchor,
    /// The draws of the stage before.
    pub(crate) sample: WeightedSample,
    /// The fit that these were drawn from; `None`: they are prior draws.
    pub(crate) fit: Option<Fit>,
}

/// A stage of independent draws.
#[derive(Debug, Clone)]
pub(crate) struct DrawStage {
    pub(crate) start: DrawStart,
    pub(crate) exponent: f64,
    pub(crate) forecast: Forecast,
    /// The draws so far of the proposal in use.
    pub(crate) sample: WeightedSample,
    pub(crate) proposal: DrawProposal,
    /// The fit of this stage's target.
    pub(crate) fit: Fit,
    /// Draws that wait for their evaluation.
    pending: Vec<Draw>,
    /// How many to ask for next.
    wanted: usize,
    /// Proposals before the one in use, and how many of them missed their target.
    attempts: usize,
    misses: usize,
    pub(crate) rounds: usize,
    pub(crate) evaluations: u64,
}

impl DrawStage {
    /// Fits a proposal to the draws of the stage before, weighted for `exponent` or for shorter steps where there is none. The
    /// draws are given back if there is none for any of them: they do not span the space, or the fit lies outside the support.
    pub(crate) fn new(
        start: DrawStart,
        exponent: f64,
        prior: &Prior,
        settings: &TmcmcSettings,
    ) -> Result<Self, Box<DrawStart>> {
        let from = start.anchor.exponent;
        let mut exponent = exponent;
        for attempt in 0..MISSES {
            let key = DrawKey::new(settings.seed, start.index, attempt);
            let Some((forecast, (fit, proposal))) = first_proposal(&start, (exponent, key), prior, settings)
            else {
                exponent = shorter(from, exponent);
                continue;
            };
            return Ok(Self {
                start,
                exponent,
                forecast,
                sample: WeightedSample::default(),
                proposal,
                fit,
                pending: Vec::new(),
                wanted: settings.particles,
                attempts: attempt,
                misses: attempt,
                rounds: 0,
                evaluations: 0,
            });
        }
        Err(Box::new(start))
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
        // A proposal is judged by its first round.
        let drawn = self.sample.states.len();
        let Some(weights) = weights.filter(|weights| drawn > particles || !is_poor(weights, &self.sample))
        else {
            return if self.misses + 1 < MISSES {
                Standing::Retreat
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

    /// Replaces the proposal by a fit to its own draws, which are then dropped. Where there is no such fit the proposal and its
    /// draws stay, and more of them are asked for.
    pub(crate) fn refit(&mut self, prior: &Prior, settings: &TmcmcSettings) {
        self.wanted = settings.particles;
        self.attempts += 1;
        let key = DrawKey::new(settings.seed, self.start.index, self.attempts);
        let fitted = self.sample.weights(self.exponent).and_then(|weights| {
            let source = (&self.sample, &weights, self.start.fit.as_ref());
            propose(source, (self.exponent, key), prior, settings)
        });
        match fitted {
            Some(fitted) => {
                (self.fit, self.proposal) = fitted;
                self.sample = WeightedSample::default();
            }
            None => self.attempts = self.attempts.max(REFINEMENTS),
        }
    }

    /// Goes back to the draws of the stage before, for a shorter step of the exponent. False if no fit is left to try.
    pub(crate) fn retreat(&mut self, prior: &Prior, settings: &TmcmcSettings) -> bool {
        self.wanted = settings.particles;
        self.sample = WeightedSample::default();
        while self.misses + 1 < MISSES {
            self.attempts += 1;
            self.misses += 1;
            self.exponent = shorter(self.start.anchor.exponent, self.exponent);
            let key = DrawKey::new(settings.seed, self.start.index, self.attempts);
            if let Some((forecast, fitted)) =
                first_proposal(&self.start, (self.exponent, key), prior, settings)
            {
                self.forecast = forecast;
                (self.fit, self.proposal) = fitted;
                return true;
            }
        }
        false
    }
}

/// The exponent after a miss.
fn shorter(from: f64, exponent: f64) -> f64 {
    from + RETREAT * (exponent - from)
}

/// What the draws of the stage before say about `exponent`, and a proposal fitted to them.
fn first_proposal(
    start: &DrawStart,
    (exponent, key): (f64, DrawKey),
    prior: &Prior,
    settings: &TmcmcSettings,
) -> Option<(Forecast, (Fit, DrawProposal))> {
    let weights = start.sample.weights(exponent)?;
    let source = (&start.sample, &weights, start.fit.as_ref());
    let fitted = propose(source, (exponent, key), prior, settings)?;
    Some((Forecast::new(&start.sample, &weights), fitted))
}

/// Whether draws have missed their target.
fn is_poor(weights: &ImportanceWeights, sample: &WeightedSample) -> bool {
    let dimension = sample.states.first().map_or(0, |state| state.coordinates.len());
    weights.share() < LEAST_SHARE || weights.ess < 2.0 * (dimension as f64 + 1.0)
}

/// A fit to weighted draws, and what to draw from: the fit, levelled, with a share of the one before.
fn propose(
    (sample, weights, before): (&WeightedSample, &ImportanceWeights, Option<&Fit>),
    (exponent, key): (f64, DrawKey),
    prior: &Prior,
    settings: &TmcmcSettings,
) -> Option<(Fit, DrawProposal)> {
    let fit = Fit::of(sample, weights, prior, settings.components, &mut key.fit())?.levelled(LEVELLED);
    let parts = (fit.clone(), before.cloned());
    let proposal = DrawProposal::new(parts, prior, key, settings.particles, exponent >= 1.0)?;
    Some((fit, proposal))
}
