//! The queries that a discovery makes to the model.

/// The model that is evaluated.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum QueriedModel {
    /// The base with these candidates, whose parameters follow the base's in this order.
    With(Vec<usize>),
    /// The base without one of its effects, a reduction, and with these candidates, whose parameters follow those that remain.
    Without(usize, Vec<usize>),
}

/// A parameter vector to evaluate.
#[derive(Debug, Clone, PartialEq)]
pub struct Query {
    /// The model to evaluate.
    pub model: QueriedModel,
    /// Whether the proposed runs are predicted, in place of the measured ones.
    pub is_proposed: bool,
    /// Whether the low-fidelity model is asked, in place of the model.
    pub is_low_fidelity: bool,
    /// The parameters, the base's first.
    pub theta: Vec<f64>,
}
