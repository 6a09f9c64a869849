//! The transition to the next stage: its exponent, its weights and its resampled chains.

use super::ching_chen;
use super::resample::systematic;
use super::schedule::exponent_step;
use super::weights::Weights;
use crate::tell::InferenceFailure;
use crate::tmcmc::covariance::CovarianceFactor;
use crate::tmcmc::pool::Pool;
use crate::tmcmc::proposal_mixture::ProposalMixture;
use crate::tmcmc::scale::initial_scale;
use crate::tmcmc::settings::{Algorithm, TmcmcSettings};
use crate::tmcmc::stage::{Chain, Stage};
use statistics::rng::Stream;

/// Stream of a stage's resampling; particles never reach this number.
const RESAMPLING: u64 = u64::MAX;

/// The transition that led to the stage in progress.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Passage {
    /// Growth of the exponent.
    pub(crate) step: f64,
    pub(crate) weight_cov: f64,
    /// Part of the increment of the log-evidence that is known already.
    pub(crate) log_evidence: f64,
}

/// Returns the random number of a stage's systematic resampling.
pub(crate) fn tooth(seed: u64, stage: usize) -> f64 {
    Stream::new(seed, stage as u64, RESAMPLING, 0).uniform()
}

/// A stage about to start, with the weights that led to it.
pub(crate) struct Transition {
    pub(crate) stage: Stage,
    pub(crate) weights: Weights,
    /// Growth of the exponent.
    pub(crate) step: f64,
}

impl Transition {
    /// Weighs the pool of the stage before, whose exponent was `exponent`, and resamples it.
    ///
    /// `scale` is the scale reached so far, `None` before the first stage.
    pub(crate) fn new(
        pool: &Pool,
        index: usize,
        exponent: f64,
        scale: Option<f64>,
        settings: &TmcmcSettings,
    ) -> Result<Self, InferenceFailure> {
        let log_likelihoods = pool.log_likelihoods();
        let remaining = 1.0 - exponent;
        let step = exponent_step(&log_likelihoods, remaining, settings.target_cov);
        let next = if step < remaining { exponent + step } else { 1.0 };
        if next <= exponent {
            return Err(InferenceFailure::ExponentStuck { exponent, step });
        }
        let weights = Weights::new(&log_likelihoods, step);
        let normalised = weights.normalised();
        let views: Vec<&[f64]> = pool
            .states
            .iter()
            .map(|state| state.coordinates.as_slice())
            .collect();
        let factor = CovarianceFactor::new(&views, &normalised);
        let tooth = tooth(settings.seed, index);
        let indices = systematic(&normalised, settings.particles, tooth);
        let chain = |(from, length): (usize, usize)| {
            let current = pool.states[from].clone();
            Chain {
                start: current.log_likelihood,
                current,
                ancestor: pool.chains[from],
                length,
            }
        };
        let stage = match settings.algorithm {
            Algorithm::Tmcmc => {
                let frozen: Vec<Vec<f64>> = indices.iter().map(|&from| views[from].to_vec()).collect();
                let chains = indices.iter().map(|&from| chain((from, settings.moves[1])));
                let scale = scale.unwrap_or_else(|| initial_scale(factor.dimension()));
                let mixture = ProposalMixture { factor, frozen };
                Stage::new(index, next, chains.collect(), mixture, scale, true)
            }
            original @ (Algorithm::ChingChen2007 | Algorithm::Basis) => {
                let chains = match original {
                    Algorithm::Basis => indices.iter().map(|&from| chain((from, 1))).collect(),
                    _ => ching_chen::leaders(&indices).into_iter().map(chain).collect(),
                };
                let mixture = ProposalMixture {
                    factor,
                    frozen: Vec::new(),
                };
                Stage::new(index, next, chains, mixture, ching_chen::SCALE, false)
            }
        };
        Ok(Self { stage, weights, step })
    }
}
