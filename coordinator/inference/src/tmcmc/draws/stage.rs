//! A stage of independent draws in progress.

use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;

use super::frame::Fit;
use super::proposal::{Draw, DrawKey, DrawProposal};
use super::sample::{Expectation, ImportanceWeights, WeightedSample};
use crate::round::Proposal;
use crate::tmcmc::pool::{ChainState, Pool};
use crate::tmcmc::settings::TmcmcSettings;

/// ESS/N of a proposal's draws below which the proposal has missed its target.
const MIN_SHARE: f64 = 0.05;

/// At exponent 1 every further draw is one of the posterior, so a larger ESS/N is worth a refit.
const MIN_SHARE_OF_POSTERIOR: f64 = 0.25;

/// Number of consecutive proposals that may miss their targets before the stage resorts to moves.
const MISSES: usize = 6;

/// Share of the step of the exponent that remains after a miss.
const RETREAT: f64 = 0.3;

/// Maximum number of refits at exponent 1 for a larger ESS/N, once a proposal has not missed.
const REFINEMENTS: usize = 4;

/// Effective draws of the posterior per particle of the population.
const EFFECTIVE_DRAWS: f64 = 2.0;

/// Maximum number of draws of the posterior per particle of the population.
const MAX_DRAWS: usize = 20;

/// Weight moved from heavy to light components of a fit (a defensive mixture).
const DEFENSIVE_WEIGHT: f64 = 0.4;

/// The start of the stage: an equally weighted sample of the stage before, and its evidence.
#[derive(Debug, Clone)]
pub(crate) struct Anchor {
    pub(crate) pool: Pool,
    pub(crate) exponent: f64,
    pub(crate) log_evidence: f64,
    pub(crate) variance: f64,
    /// The surviving fraction of the prior draws, where these are the anchor: survivors and draws.
    pub(crate) survivors: Option<[usize; 2]>,
}

/// The prediction of this stage's target from the draws of the stage before.
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

/// The decision after a completed round of draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Standing {
    /// The draws represent their target.
    Done,
    /// The proposal stays, and must give this many further draws.
    More(usize),
    /// A better fit is worth its draws.
    Refit,
    /// The draws have missed their target: a shorter step may reach it.
    Retreat,
    /// No proposal reached its target.
    Missed,
}

/// The input of a stage.
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
    pending: Vec<Draw>,
    /// Number of draws of the next round.
    count: usize,
    /// Number of proposals before the one in use, and of those that missed their target.
    attempts: usize,
    misses: usize,
    pub(crate) rounds: usize,
    pub(crate) evaluations: u64,
}

impl DrawStage {
    /// Fits a proposal to the draws of the stage before, weighted for `exponent` or for shorter steps if there is none. Gives the
    /// draws back if no step has a fit: they do not span the space, or the fit lies outside the support.
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
                count: settings.particles,
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
        self.pending = self.proposal.draws(self.count, prior);
        let draws = self.pending.iter().enumerate();
        draws
            .map(|(index, draw)| Proposal::new(index, prior.theta(&draw.coordinates)))
            .collect()
    }

    /// Takes the results of the round, in the order of its draws.
    pub(crate) fn accept(&mut self, results: Vec<LogLikelihood>) {
        self.rounds += 1;
        for (draw, log_likelihood) in self.pending.drain(..).zip(results) {
            self.evaluations += 1;
            let state = ChainState {
                coordinates: draw.coordinates,
                log_prior: draw.log_prior,
                log_likelihood,
            };
            self.sample.push(state, draw.log_ratio);
        }
    }

    /// Decides how the stage continues after the draws so far; `weights` are theirs at this stage's exponent.
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
        if weights.share() < MIN_SHARE_OF_POSTERIOR && self.attempts < REFINEMENTS {
            return Standing::Refit;
        }
        let (goal, max_draws) = (EFFECTIVE_DRAWS * particles as f64, MAX_DRAWS * particles);
        if weights.ess >= goal || drawn >= max_draws {
            return Standing::Done;
        }
        let total = (goal / weights.share()).ceil().min(max_draws as f64) as usize;
        // A round has no more proposals than there are particles.
        Standing::More(total.saturating_sub(drawn).clamp(1, particles))
    }

    /// Asks the same proposal for further draws.
    pub(crate) fn ask_more(&mut self, count: usize) {
        self.count = count;
    }

    /// Replaces the proposal by a fit to its draws, which are then dropped. Without such a fit the proposal and its draws stay, and
    /// further draws are asked for.
    pub(crate) fn refit(&mut self, prior: &Prior, settings: &TmcmcSettings) {
        self.count = settings.particles;
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

    /// Returns to the draws of the stage before, for a shorter step of the exponent; false if no fit is left to try.
    pub(crate) fn retreat(&mut self, prior: &Prior, settings: &TmcmcSettings) -> bool {
        self.count = settings.particles;
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

/// Returns the exponent after a miss.
fn shorter(from: f64, exponent: f64) -> f64 {
    from + RETREAT * (exponent - from)
}

/// Returns the prediction for `exponent` from the draws of the stage before, and a proposal fitted to them.
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

/// Returns whether draws have missed their target.
fn is_poor(weights: &ImportanceWeights, sample: &WeightedSample) -> bool {
    let dimension = sample.states.first().map_or(0, |state| state.coordinates.len());
    weights.share() < MIN_SHARE || weights.ess < 2.0 * (dimension as f64 + 1.0)
}

/// Returns a fit to weighted draws, and the proposal: the fit as a defensive mixture, with a share of the one before.
fn propose(
    (sample, weights, before): (&WeightedSample, &ImportanceWeights, Option<&Fit>),
    (exponent, key): (f64, DrawKey),
    prior: &Prior,
    settings: &TmcmcSettings,
) -> Option<(Fit, DrawProposal)> {
    let fit =
        Fit::new(sample, weights, prior, settings.components, &mut key.fit())?.defensive(DEFENSIVE_WEIGHT);
    let parts = (fit.clone(), before.cloned());
    let proposal = DrawProposal::new(parts, prior, key, settings.particles, exponent >= 1.0)?;
    Some((fit, proposal))
}
