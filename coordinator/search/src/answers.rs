//! The answers that a search of an expensive model has already, so that no evaluation is asked for twice.

use std::collections::BTreeMap;

/// An answer: the values of a query; `None` where the model rejected the parameters.
pub(super) type Answer = Option<Vec<f64>>;

/// An evaluation: a model by the hash of its variant, and its parameters by their bits.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EvaluationKey {
    hash: String,
    theta: Vec<u64>,
}

impl EvaluationKey {
    pub(super) fn new(hash: &str, theta: &[f64]) -> Self {
        Self {
            hash: hash.to_owned(),
            theta: theta.iter().map(|value| value.to_bits()).collect(),
        }
    }
}

/// The answers of a search by evaluation.
///
/// Fits of one model from several starts meet at the same points, and a step of an inferred noise sd changes no prediction.
#[derive(Debug, Default)]
pub(super) struct Answers {
    known: BTreeMap<EvaluationKey, Answer>,
}

impl Answers {
    /// Returns the answer of an evaluation, if it was asked for.
    pub(super) fn find(&self, evaluation: &EvaluationKey) -> Option<&Answer> {
        self.known.get(evaluation)
    }

    /// Keeps an answer.
    pub(super) fn insert(&mut self, evaluation: EvaluationKey, values: Option<&[f64]>) {
        self.known.insert(evaluation, values.map(<[f64]>::to_vec));
    }
}
