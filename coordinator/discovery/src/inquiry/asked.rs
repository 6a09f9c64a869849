//! What the model is asked.

/// Which model.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Model {
    /// The base with these candidates, whose parameters follow the base's in this order.
    With(Vec<usize>),
    /// The base without one of its effects.
    Without(usize),
}

/// A parameter vector and what it is asked of.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// Which model.
    pub model: Model,
    /// The proposed runs instead of those that were measured.
    pub is_proposed: bool,
    /// The parameters.
    pub theta: Vec<f64>,
}
