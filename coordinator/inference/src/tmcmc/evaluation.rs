//! Tell a sampler what an evaluation gave.

use statistics::log_likelihood::LogLikelihood;
use statistics::metamodel::{ModelPair, SubchainEnd};

/// What the evaluation of a proposal gave.
#[derive(Debug, Clone, PartialEq)]
pub enum EvaluationResult {
    /// The model was asked at the proposed parameters.
    Here {
        /// ln p(data | theta) there.
        log_likelihood: LogLikelihood,
        /// What both models say there, where a metamodel is to learn from it.
        pair: Option<ModelPair>,
    },
    /// The model was asked at the end of a subchain.
    Moved {
        /// The end.
        end: SubchainEnd,
        /// ln p(data | theta) and the pair there; `None` where no move was accepted, so that nothing had to be asked.
        found: Option<(LogLikelihood, Option<ModelPair>)>,
    },
}

impl From<LogLikelihood> for EvaluationResult {
    fn from(log_likelihood: LogLikelihood) -> Self {
        Self::Here {
            log_likelihood,
            pair: None,
        }
    }
}

impl EvaluationResult {
    /// Whether the model was asked at all.
    pub(super) fn is_evaluated(&self) -> bool {
        !matches!(self, Self::Moved { found: None, .. })
    }

    /// Whether the model was asked and rejected the parameters.
    pub(super) fn is_rejected(&self) -> bool {
        match self {
            Self::Here { log_likelihood, .. } => log_likelihood.is_impossible(),
            Self::Moved { found, .. } => found.as_ref().is_some_and(|(value, _)| value.is_impossible()),
        }
    }
}
