//! The answers that a search of an expensive model has already, so that no evaluation is asked for twice.

use std::collections::BTreeMap;

/// An answer: the values of a query; `None` where the model rejected the parameters.
pub(super) type Answer = Option<Vec<f64>>;

/// A model by the hash of its variant, and its parameters by their bits.
type EvaluationKey = (String, Vec<u64>);

/// The answers of a search by model and parameters.
///
/// Fits of one model from several starts meet at the same points, and a step of an inferred noise sd changes no prediction.
#[derive(Debug, Default)]
pub(super) struct Answers {
    known: BTreeMap<EvaluationKey, Answer>,
}

impl Answers {
    /// Returns the answer of a model at these parameters, if it was asked there.
    pub(super) fn find(&self, (hash, theta): &(String, Vec<f64>)) -> Option<&Answer> {
        self.known.get(&key(hash, theta))
    }

    /// Keeps an answer.
    pub(super) fn insert(&mut self, (hash, theta): &(String, Vec<f64>), values: Option<&[f64]>) {
        self.known.insert(key(hash, theta), values.map(<[f64]>::to_vec));
    }
}

fn key(hash: &str, theta: &[f64]) -> EvaluationKey {
    (
        hash.to_owned(),
        theta.iter().map(|value| value.to_bits()).collect(),
    )
}
