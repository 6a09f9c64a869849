//! The questions of a search to the model.

/// The model that is evaluated.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum QueriedModel {
    /// The base with these candidates, whose parameters follow the base's in this order.
    With(Vec<usize>),
    /// The base without one of its effects, a reduction.
    Without(usize),
}

/// A parameter vector to evaluate.
#[derive(Debug, Clone, PartialEq)]
pub struct Query {
    /// The model.
    pub model: QueriedModel,
    /// On the proposed runs instead of the measured ones.
    pub is_proposed: bool,
    /// Of the model's companion.
    pub is_companion: bool,
    /// The parameters.
    pub theta: Vec<f64>,
}
