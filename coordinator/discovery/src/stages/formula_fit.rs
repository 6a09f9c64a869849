//! What a search asks of formulas of a law, and what it keeps of their fits.

use crate::stages::law_curve::LawCurve;

/// The law of which a search wants formulas.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaRequest {
    /// Index of the law in the task.
    pub law: usize,
    /// Its curve, with a covariance that accounts for the misfit.
    pub curve: LawCurve,
    /// The effects beside the law.
    pub(super) effects: Vec<usize>,
}

/// A formula of a law as it was fitted through the model.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaFit {
    /// Its place among the offered formulas.
    pub formula: usize,
    /// Log evidence over that of the model without the law, over the misfit \[nats\].
    pub log_bayes_factor: f64,
    /// Its most probable parameters.
    pub parameters: Vec<f64>,
}
