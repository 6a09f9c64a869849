//! The chains of one stage, moved one step per round.

use super::pool::{ChainState, Pool};
use super::proposal_mixture::{ProposalMixture, ProposedMove};
use super::scale::target_acceptance;
use crate::round::Proposal;
use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;
use statistics::rng::Stream;

/// One chain of a stage.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    pub(super) start: LogLikelihood,
    pub(super) current: ChainState,
    /// The chain of the previous stage that the start came from; its descendants are not independent.
    pub(super) ancestor: usize,
    /// Steps after which the chain ends.
    pub(super) length: usize,
}

/// A step of one chain, decided when its log-likelihood is known.
#[derive(Debug, Clone)]
struct Step {
    chain: usize,
    /// ln of the uniform number that decides.
    log_uniform: f64,
    candidate: ProposedMove,
    /// Log-density of the candidate's coordinates under the prior.
    log_prior: f64,
}

impl Step {
    /// Returns whether the candidate is in the prior's support; outside, it is rejected without evaluation.
    fn is_inside(&self) -> bool {
        self.log_prior > f64::NEG_INFINITY
    }

    /// Decides by the rule of Metropolis and Hastings, at a tempering exponent.
    fn is_accepted(&self, log_likelihood: LogLikelihood, current: &ChainState, exponent: f64) -> bool {
        let gain = log_likelihood.value() - current.log_likelihood.value();
        let ratio = exponent * gain + (self.log_prior - current.log_prior) + self.candidate.log_correction;
        self.log_uniform < ratio
    }
}

/// A stage in progress.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    pub(super) index: usize,
    pub(super) exponent: f64,
    pub(super) chains: Vec<Chain>,
    /// Every state of the chains after their start.
    pub(super) pool: Pool,
    pub(super) mixture: ProposalMixture,
    pub(super) scale: f64,
    pub(super) adaptive: bool,
    pub(super) step: usize,
    pub(super) accepted: u64,
    pub(super) proposed: u64,
    pub(super) evaluations: u64,
    steps: Vec<Step>,
}

impl Stage {
    pub(super) fn new(
        index: usize,
        exponent: f64,
        chains: Vec<Chain>,
        mixture: ProposalMixture,
        scale: f64,
        adaptive: bool,
    ) -> Self {
        Self {
            index,
            exponent,
            chains,
            pool: Pool::default(),
            mixture,
            scale,
            adaptive,
            step: 0,
            accepted: 0,
            proposed: 0,
            evaluations: 0,
            steps: Vec::new(),
        }
    }

    /// Returns the share of the proposals accepted so far, those outside the prior counted as rejected.
    pub(super) fn acceptance(&self) -> Option<f64> {
        (self.proposed > 0).then(|| self.accepted as f64 / self.proposed as f64)
    }

    /// Draws the next step of every unfinished chain; returns the proposals to evaluate.
    pub(super) fn propose(&mut self, prior: &Prior, seed: u64) -> Vec<Proposal> {
        self.steps.clear();
        let mut proposals = Vec::new();
        for (chain, walker) in self.chains.iter().enumerate() {
            if self.step >= walker.length {
                continue;
            }
            let step = self.step as u64 + 1;
            let mut stream = Stream::new(seed, self.index as u64, chain as u64, step);
            let log_uniform = libm::log(stream.uniform());
            let from = &walker.current.coordinates;
            let candidate = self.mixture.candidate(from, self.scale, &mut stream);
            let log_prior = prior.log_density_of_coordinates(&candidate.coordinates);
            let step = Step {
                chain,
                log_uniform,
                candidate,
                log_prior,
            };
            if step.is_inside() {
                proposals.push(Proposal::new(chain, prior.theta(&step.candidate.coordinates)));
            }
            self.steps.push(step);
        }
        proposals
    }

    /// Accepts or rejects every step; `results` are those of the last proposals, in their order.
    pub(super) fn accept(&mut self, results: Vec<LogLikelihood>) {
        let mut results = results.into_iter();
        let (mut scaled, mut scaled_accepted) = (0_u64, 0_u64);
        for step in std::mem::take(&mut self.steps) {
            let chain = &mut self.chains[step.chain];
            let result = if step.is_inside() { results.next() } else { None };
            let is_scaled = u64::from(step.candidate.scaled);
            self.evaluations += u64::from(result.is_some());
            self.proposed += 1;
            scaled += is_scaled;
            if let Some(log_likelihood) = result
                && step.is_accepted(log_likelihood, &chain.current, self.exponent)
            {
                chain.current = ChainState {
                    coordinates: step.candidate.coordinates,
                    log_prior: step.log_prior,
                    log_likelihood,
                };
                self.accepted += 1;
                scaled_accepted += is_scaled;
            }
            self.pool.push(step.chain, chain.current.clone());
        }
        self.step += 1;
        if self.adaptive && scaled > 0 {
            let acceptance = scaled_accepted as f64 / scaled as f64;
            self.scale *= libm::exp(acceptance - target_acceptance(self.mixture.factor.dimension()));
        }
    }

    /// Returns whether every chain has taken all its steps.
    pub(super) fn is_exhausted(&self) -> bool {
        self.chains.iter().all(|chain| self.step >= chain.length)
    }
}
