//! Move the chains of one stage, one step per round.

use super::population::{Pool, State};
use super::proposal::{Candidate, Mixture, target_acceptance};
use crate::log_likelihood::LogLikelihood;
use crate::prior::Prior;
use crate::rng::Stream;
use crate::round::Proposal;

/// One chain of a stage.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    pub(super) start: LogLikelihood,
    pub(super) current: State,
    /// The chain of the previous stage that the start came from; its descendants are not independent.
    pub(super) ancestor: usize,
    /// Steps after which the chain ends.
    pub(super) length: usize,
}

/// A step of one chain, decided when its log-likelihood is known.
#[derive(Debug, Clone)]
struct Step {
    chain: usize,
    candidate: Candidate,
    log_prior: f64,
    /// ln of the uniform number that decides.
    log_uniform: f64,
}

/// A stage in progress.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    pub(super) index: usize,
    pub(super) exponent: f64,
    pub(super) chains: Vec<Chain>,
    /// Every state that a chain took after its start.
    pub(super) pool: Pool,
    pub(super) mixture: Mixture,
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
        mixture: Mixture,
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

    /// Share of the proposals accepted so far, those outside the prior counted as rejected.
    pub(super) fn acceptance(&self) -> Option<f64> {
        (self.proposed > 0).then(|| self.accepted as f64 / self.proposed as f64)
    }

    /// Draws the next step of every chain that goes on; returns the proposals inside the prior's support.
    pub(super) fn propose(&mut self, prior: &Prior, seed: u64) -> Vec<Proposal> {
        self.steps.clear();
        let mut proposals = Vec::new();
        for (chain, walker) in self.chains.iter().enumerate() {
            if self.step >= walker.length {
                continue;
            }
            let mut stream = Stream::new(seed, self.index as u64, chain as u64, self.step as u64 + 1);
            let log_uniform = libm::log(stream.uniform());
            let candidate = self
                .mixture
                .candidate(&walker.current.coordinates, self.scale, &mut stream);
            let log_prior = prior.log_density_of_coordinates(&candidate.coordinates);
            if log_prior > f64::NEG_INFINITY {
                proposals.push(Proposal {
                    particle: chain,
                    theta: prior.theta(&candidate.coordinates),
                });
            }
            self.steps.push(Step {
                chain,
                candidate,
                log_prior,
                log_uniform,
            });
        }
        proposals
    }

    /// Accepts or rejects every step; `answers` are the log-likelihoods of the last proposals, in their
    /// order.
    pub(super) fn accept(&mut self, answers: &[LogLikelihood]) {
        self.evaluations += answers.len() as u64;
        let mut answers = answers.iter();
        let (mut scaled, mut scaled_accepted) = (0_u32, 0_u32);
        for step in self.steps.drain(..) {
            let inside = step.log_prior > f64::NEG_INFINITY;
            let answer = if inside { answers.next().copied() } else { None };
            let chain = &mut self.chains[step.chain];
            let follows_scale = step.candidate.scaled;
            let accepted = match answer {
                Some(answer @ LogLikelihood::Finite(nats)) => {
                    let gain = nats.get() - chain.current.log_likelihood.value();
                    let ratio = self.exponent * gain
                        + (step.log_prior - chain.current.log_prior)
                        + step.candidate.log_correction;
                    let accept = step.log_uniform < ratio;
                    if accept {
                        chain.current = State {
                            coordinates: step.candidate.coordinates,
                            log_prior: step.log_prior,
                            log_likelihood: answer,
                        };
                    }
                    accept
                }
                Some(LogLikelihood::Impossible) | None => false,
            };
            self.proposed += 1;
            self.accepted += u64::from(accepted);
            if follows_scale {
                scaled += 1;
                scaled_accepted += u32::from(accepted);
            }
            self.pool.push(step.chain, chain.current.clone());
        }
        self.step += 1;
        if self.adaptive && scaled > 0 {
            let acceptance = f64::from(scaled_accepted) / f64::from(scaled);
            self.scale *= libm::exp(acceptance - target_acceptance(self.mixture.factor.dimension()));
        }
    }

    /// Whether every chain has taken all its steps.
    pub(super) fn is_exhausted(&self) -> bool {
        self.chains.iter().all(|chain| self.step >= chain.length)
    }
}
