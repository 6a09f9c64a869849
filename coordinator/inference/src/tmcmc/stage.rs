//! The chains of one stage, moved one step per round.

use std::sync::Arc;

use super::evaluation::EvaluationResult;
use super::scale::target_acceptance;
use crate::round::Proposal;
use statistics::log_likelihood::LogLikelihood;
use statistics::metamodel::{
    ChainState, Metamodel, ModelPair, PLAIN_STEPS, Pool, ProposalMixture, ProposedMove, Subchain, SubchainEnd,
};
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
    kind: Kind,
}

/// The kind of candidate of a step.
#[derive(Debug, Clone)]
enum Kind {
    /// Outside the prior's support: rejected without evaluation.
    Outside { scaled: bool },
    /// One move, to be evaluated.
    Plain { candidate: ProposedMove, log_prior: f64 },
    /// A subchain of the metamodel.
    Delayed,
}

/// The outcome of a step: the new state if it was accepted, and the numbers of scaled moves and of accepted ones.
struct Decision {
    state: Option<ChainState>,
    scaled: u32,
    scaled_accepted: u32,
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
    /// The metamodel that takes moves between evaluations, if there is one.
    pub(super) metamodel: Option<Arc<Metamodel>>,
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
            metamodel: None,
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
            let kind = if self.metamodel.is_some() && stream.uniform() >= PLAIN_STEPS {
                proposals.push(Proposal {
                    particle: chain,
                    theta: prior.theta(from),
                    subchain: Some(Subchain {
                        chain: chain as u64,
                        step,
                        scale: self.scale,
                    }),
                });
                Kind::Delayed
            } else {
                let candidate = self.mixture.candidate(from, self.scale, &mut stream);
                let log_prior = prior.log_density_of_coordinates(&candidate.coordinates);
                if log_prior > f64::NEG_INFINITY {
                    proposals.push(Proposal::plain(chain, prior.theta(&candidate.coordinates)));
                    Kind::Plain { candidate, log_prior }
                } else {
                    Kind::Outside {
                        scaled: candidate.scaled,
                    }
                }
            };
            self.steps.push(Step {
                chain,
                log_uniform,
                kind,
            });
        }
        proposals
    }

    /// Accepts or rejects every step; `results` are those of the last proposals, in their order.
    pub(super) fn accept(&mut self, prior: &Prior, results: Vec<EvaluationResult>) {
        let mut results = results.into_iter();
        let (mut scaled, mut scaled_accepted) = (0_u64, 0_u64);
        for step in std::mem::take(&mut self.steps) {
            let result = match step.kind {
                Kind::Outside { .. } => None,
                Kind::Plain { .. } | Kind::Delayed => results.next(),
            };
            self.evaluations += u64::from(result.as_ref().is_some_and(EvaluationResult::is_evaluated));
            let chain = &mut self.chains[step.chain];
            let decision = decide(
                step.kind,
                step.log_uniform,
                result,
                &chain.current,
                self.exponent,
                prior,
            );
            self.proposed += 1;
            scaled += u64::from(decision.scaled);
            scaled_accepted += u64::from(decision.scaled_accepted);
            if let Some(state) = decision.state {
                chain.current = state;
                self.accepted += 1;
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

/// Accepts or rejects a step.
fn decide(
    kind: Kind,
    log_uniform: f64,
    result: Option<EvaluationResult>,
    current: &ChainState,
    exponent: f64,
    prior: &Prior,
) -> Decision {
    let gain = |log_likelihood: LogLikelihood| log_likelihood.value() - current.log_likelihood.value();
    match (kind, result) {
        (
            Kind::Plain { candidate, log_prior },
            Some(EvaluationResult::AtProposal { log_likelihood, pair }),
        ) => {
            let ratio =
                exponent * gain(log_likelihood) + (log_prior - current.log_prior) + candidate.log_correction;
            let accepted = log_uniform < ratio;
            let scaled = u32::from(candidate.scaled);
            Decision {
                state: accepted.then(|| ChainState {
                    coordinates: candidate.coordinates,
                    log_prior,
                    log_likelihood,
                    pair: pair.map(Arc::new),
                }),
                scaled,
                scaled_accepted: scaled * u32::from(accepted),
            }
        }
        (Kind::Delayed, Some(EvaluationResult::AtSubchainEnd { end, found })) => Decision {
            scaled: end.scaled,
            scaled_accepted: end.scaled_accepted,
            state: found
                .filter(|(log_likelihood, _)| {
                    // The subchain accounts for the prior and the metamodel already.
                    log_uniform < exponent * (gain(*log_likelihood) - end.log_gain)
                })
                .map(|(log_likelihood, pair)| moved(prior, &end, log_likelihood, pair)),
        },
        (Kind::Outside { scaled }, _) => Decision {
            state: None,
            scaled: u32::from(scaled),
            scaled_accepted: 0,
        },
        // `Sampler::tell` refuses a result of the wrong kind.
        _ => Decision {
            state: None,
            scaled: 0,
            scaled_accepted: 0,
        },
    }
}

/// Returns the state at the end of a subchain.
fn moved(
    prior: &Prior,
    end: &SubchainEnd,
    log_likelihood: LogLikelihood,
    pair: Option<ModelPair>,
) -> ChainState {
    let coordinates = prior.coordinates(&end.theta);
    ChainState {
        log_prior: prior.log_density_of_coordinates(&coordinates),
        coordinates,
        log_likelihood,
        pair: pair.map(Arc::new),
    }
}
