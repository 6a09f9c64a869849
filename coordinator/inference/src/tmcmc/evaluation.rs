//! The result of an evaluation, as it is told to a sampler.

use statistics::log_likelihood::LogLikelihood;
use statistics::metamodel::{ModelPair, SubchainEnd};

/// The result of the evaluation of a proposal.
#[derive(Debug, Clone, PartialEq)]
pub enum EvaluationResult {
    /// The model was evaluated at the proposed parameters.
    AtProposal {
        /// ln p(data | theta) there.
        log_likelihood: LogLikelihood,
        /// The predictions of both models there, if a metamodel learns from them.
        pair: Option<ModelPair>,
    },
    /// The model was evaluated at the end of a subchain.
    AtSubchainEnd {
        /// The parameters at the end.
        end: SubchainEnd,
        /// ln p(data | theta) and the pair there; `None` where no move was accepted, so that no evaluation was needed.
        found: Option<(LogLikelihood, Option<ModelPair>)>,
    },
}

impl From<LogLikelihood> for EvaluationResult {
    fn from(log_likelihood: LogLikelihood) -> Self {
        Self::AtProposal {
            log_likelihood,
            pair: None,
        }
    }
}

impl EvaluationResult {
    pub(super) fn is_evaluated(&self) -> bool {
        !matches!(self, Self::AtSubchainEnd { found: None, .. })
    }

    pub(super) fn is_rejected(&self) -> bool {
        match self {
            Self::AtProposal { log_likelihood, .. } => log_likelihood.is_impossible(),
            Self::AtSubchainEnd { found, .. } => {
                found.as_ref().is_some_and(|(value, _)| value.is_impossible())
            }
        }
    }
}
