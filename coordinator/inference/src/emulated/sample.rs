//! Samples of the emulated target: no evaluation of the model is needed.

use statistics::prior::Prior;
use statistics::rng::Stream;

use super::target::{EmulatedScore, EmulatedTarget, log_likelihood};
use crate::tell::InferenceFailure;
use crate::tmcmc::draws::{DrawKey, DrawProposal, Fit, WeightedSample};
use crate::tmcmc::pool::ChainState;
use crate::tmcmc::transition::systematic;
use crate::tmcmc::{Particle, Sampler, StageMethod, TmcmcSettings};

/// Size of a sample.
pub(super) const PARTICLES: usize = 400;

/// Components of the mixtures that propose draws.
const COMPONENTS: usize = 8;

/// Draws of a mixture from which a sample is selected.
const REDRAWN: usize = 1200;

/// Draws of a first mixture, to which the mixture is fitted that measures the evidence of the emulated posterior, and the draws of that.
const PILOT_DRAWS: usize = 4000;
const EVIDENCE_DRAWS: usize = 20_000;

/// Share of effective draws below which a mixture misses its target.
const MIN_SHARE: f64 = 0.1;

/// Tooth of the comb that resamples.
const TOOTH: f64 = 0.5;

/// Number of the seeds' random stream, which no sampler uses.
const SEED_STEP: u64 = 1 << 40;

/// Equally weighted draws of an emulated target.
#[derive(Debug, Clone)]
pub(crate) struct EmulatedSample {
    /// The draws, with their emulated log-likelihoods.
    pub(crate) particles: Vec<Particle>,
    /// ln (density of the target / prior density) of each draw, not normalised.
    pub(crate) log_densities: Vec<f64>,
    pub(crate) log_evidence: f64,
}

impl EmulatedSample {
    /// Draws from the prior.
    pub(crate) fn from_prior(prior: &Prior, seed: u64) -> Self {
        let draw = |index: usize| {
            let theta = prior.sample(&mut Stream::new(seed, 0, index as u64, SEED_STEP + 1));
            Particle {
                log_likelihood: log_likelihood(0.0),
                log_prior: prior.log_density(&theta),
                theta,
            }
        };
        Self {
            particles: (0..PARTICLES).map(draw).collect(),
            log_densities: vec![0.0; PARTICLES],
            log_evidence: 0.0,
        }
    }

    /// Returns the parameter vectors of the draws.
    pub(crate) fn thetas(&self) -> Vec<&[f64]> {
        self.particles
            .iter()
            .map(|particle| particle.theta.as_slice())
            .collect()
    }

    /// Fits a mixture to the draws, and cuts it at the support. `None` if no mixture fits.
    pub(crate) fn proposal(&self, prior: &Prior, key: DrawKey) -> Option<DrawProposal> {
        cut((self.fit(prior, key)?, None), prior, key)
    }

    /// Fits a mixture to the draws.
    fn fit(&self, prior: &Prior, key: DrawKey) -> Option<Fit> {
        let mut sample = WeightedSample::default();
        for particle in &self.particles {
            sample.push(state(prior, &particle.theta, 0.0), 0.0);
        }
        fit(&sample, 0.0, prior, key)
    }
}

/// Draws of the emulated posterior from a proposal of known density.
pub(crate) struct PosteriorDraws {
    pub(crate) thetas: Vec<Vec<f64>>,
    /// ln of the emulated likelihood of each draw.
    pub(crate) log_likelihoods: Vec<f64>,
    /// ln (prior density / proposal density) of each draw.
    pub(crate) log_ratios: Vec<f64>,
    /// Normalised weights of the emulated posterior.
    pub(crate) weights: Vec<f64>,
    pub(crate) log_evidence: f64,
    pub(crate) log_evidence_variance: f64,
    pub(crate) proposal: DrawProposal,
}

/// Draws with their emulated likelihoods and their weights.
struct ScoredDraws {
    sample: WeightedSample,
    thetas: Vec<Vec<f64>>,
    scores: Vec<EmulatedScore>,
}

impl EmulatedTarget<'_> {
    /// Draws a sample at an exponent: by a mixture fitted to draws that lie near the target, or else by a sampler from the prior.
    ///
    /// # Arguments
    /// - `from`: a sample of another target.
    pub(crate) fn sample(
        &self,
        exponent: f64,
        from: &EmulatedSample,
        seed: u64,
    ) -> Result<EmulatedSample, InferenceFailure> {
        match self.redrawn(exponent, from, seed) {
            Some(sample) => Ok(sample),
            None => self.sampled(exponent, seed),
        }
    }

    fn redrawn(&self, exponent: f64, from: &EmulatedSample, seed: u64) -> Option<EmulatedSample> {
        let thetas = from
            .particles
            .iter()
            .map(|particle| particle.theta.clone())
            .collect();
        let old = self.scored(
            thetas,
            from.log_densities.iter().map(|density| -density),
            exponent,
        );
        if old.sample.weights(1.0)?.share() < MIN_SHARE {
            return None;
        }
        let key = DrawKey::new(seed, 0, 0);
        let mut proposal = cut((fit(&old.sample, 1.0, self.prior, key)?, None), self.prior, key)?;
        let new = self.drawn(&mut proposal, REDRAWN, exponent);
        let weights = new.sample.weights(1.0)?;
        if weights.share() < MIN_SHARE {
            return None;
        }
        let chosen = systematic(&weights.normalised, PARTICLES, TOOTH);
        Some(EmulatedSample {
            particles: chosen
                .iter()
                .map(|&i| self.particle(&new.thetas[i], &new.scores[i]))
                .collect(),
            log_densities: chosen.iter().map(|&i| new.scores[i].value(exponent)).collect(),
            log_evidence: weights.log_mean,
        })
    }

    fn sampled(&self, exponent: f64, seed: u64) -> Result<EmulatedSample, InferenceFailure> {
        let settings = TmcmcSettings {
            stages: StageMethod::Draws,
            particles: PARTICLES.max(16 * (self.prior.dimension() + 1)),
            components: COMPONENTS,
            seed,
            ..TmcmcSettings::default()
        };
        let mut sampler = Sampler::new(self.prior.clone(), settings)
            .map_err(|_| InferenceFailure::AllImpossible { draws: 0 })?;
        let posterior = loop {
            for pending in sampler.round().pending().to_vec() {
                let value = self.score(&pending.theta).value(exponent);
                // Every listed proposal is told once.
                let _ = sampler.tell(pending.particle, log_likelihood(value));
            }
            if let Some(failure) = sampler.failure() {
                return Err(failure);
            }
            if let Some(posterior) = sampler.posterior() {
                break posterior;
            }
        };
        let particles = posterior.particles.iter();
        Ok(EmulatedSample {
            log_densities: particles.clone().map(|p| p.log_likelihood.value()).collect(),
            particles: particles
                .map(|p| self.particle(&p.theta, &self.score(&p.theta)))
                .collect(),
            log_evidence: posterior.log_evidence,
        })
    }

    /// Draws from a mixture fitted to a sample of the emulated posterior, and weighs the draws. `None` if no mixture fits.
    ///
    /// # Arguments
    /// - `wide`: a sample of the stage before. A share of the draws comes from a mixture fitted to it, which bounds the weights in the
    ///   tails of the emulated posterior.
    pub(crate) fn posterior_draws(
        &self,
        sample: &EmulatedSample,
        wide: &EmulatedSample,
        seed: u64,
    ) -> Option<PosteriorDraws> {
        let mut first = sample.proposal(self.prior, DrawKey::new(seed, 0, 1))?;
        let pilot = self.drawn(&mut first, PILOT_DRAWS, 1.0);
        let key = DrawKey::new(seed, 0, 3);
        let fits = (
            fit(&pilot.sample, 1.0, self.prior, key)?,
            wide.fit(self.prior, key),
        );
        let mut proposal = cut(fits, self.prior, key)?;
        let ScoredDraws {
            sample,
            thetas,
            scores,
        } = self.drawn(&mut proposal, EVIDENCE_DRAWS, 1.0);
        let weights = sample.weights(1.0)?;
        Some(PosteriorDraws {
            thetas,
            log_likelihoods: scores.iter().map(|score| score.value(1.0)).collect(),
            log_ratios: sample.log_ratios,
            log_evidence: weights.log_mean,
            log_evidence_variance: weights.log_mean_variance() + proposal.inside_variance,
            weights: weights.normalised,
            proposal,
        })
    }

    fn drawn(&self, proposal: &mut DrawProposal, count: usize, exponent: f64) -> ScoredDraws {
        let draws = proposal.draws(count, self.prior);
        let thetas = draws
            .iter()
            .map(|draw| self.prior.theta(&draw.coordinates))
            .collect();
        self.scored(thetas, draws.iter().map(|draw| draw.log_ratio), exponent)
    }

    fn scored(
        &self,
        thetas: Vec<Vec<f64>>,
        log_ratios: impl Iterator<Item = f64>,
        exponent: f64,
    ) -> ScoredDraws {
        let mut sample = WeightedSample::default();
        let scores: Vec<EmulatedScore> = thetas.iter().map(|theta| self.score(theta)).collect();
        for ((theta, score), log_ratio) in thetas.iter().zip(&scores).zip(log_ratios) {
            sample.push(state(self.prior, theta, score.value(exponent)), log_ratio);
        }
        ScoredDraws {
            sample,
            thetas,
            scores,
        }
    }
}

/// Returns a mixture fitted to a weighted sample at an exponent.
fn fit(sample: &WeightedSample, exponent: f64, prior: &Prior, key: DrawKey) -> Option<Fit> {
    let weights = sample.weights(exponent)?;
    Fit::new(sample, &weights, prior, COMPONENTS, &mut key.fit())
}

/// Returns the proposal of a mixture, with a share of a wider one, cut at the support.
fn cut(fits: (Fit, Option<Fit>), prior: &Prior, key: DrawKey) -> Option<DrawProposal> {
    DrawProposal::new(fits, prior, key, PARTICLES, true)
}

fn state(prior: &Prior, theta: &[f64], value: f64) -> ChainState {
    let coordinates = prior.coordinates(theta);
    ChainState {
        log_prior: prior.log_density_of_coordinates(&coordinates),
        coordinates,
        log_likelihood: log_likelihood(value),
    }
}

/// Returns the seed of the samples of a round.
pub(crate) fn round_seed(seed: u64, round: u64) -> u64 {
    Stream::new(seed, round, 0, SEED_STEP).below(usize::MAX) as u64
}
