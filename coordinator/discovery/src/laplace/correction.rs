//! The low-fidelity model as a control variate of derivatives.

/// Derivative of the model minus derivative of the low-fidelity model.
#[derive(Debug, Clone)]
pub(crate) struct Correction {
    pub(crate) beyond: Vec<f64>,
    /// Whether it is a difference over a long step of the screen, which is accurate enough for the steps of a fit but not for an
    /// evidence.
    pub(crate) is_secant: bool,
}

impl Correction {
    /// Makes a correction of zero, which a fit must replace by a measured one.
    pub(crate) fn none(values: usize) -> Self {
        Self {
            beyond: vec![0.0; values],
            is_secant: true,
        }
    }

    /// Returns the correction from both derivatives over the same step.
    pub(crate) fn between(model: &[f64], low_fidelity: &[f64], is_secant: bool) -> Self {
        let pairs = model.iter().zip(low_fidelity);
        Self {
            beyond: pairs.map(|(model, low_fidelity)| model - low_fidelity).collect(),
            is_secant,
        }
    }

    /// Returns the model's derivative, from the low-fidelity derivative.
    pub(crate) fn applied_to(&self, low_fidelity: &[f64]) -> Vec<f64> {
        let pairs = low_fidelity.iter().zip(&self.beyond);
        pairs
            .map(|(low_fidelity, beyond)| low_fidelity + beyond)
            .collect()
    }
}

/// Returns the difference quotient of predicted values over a step of one coordinate.
pub(crate) fn quotient(values: &[f64], from: &[f64], step: f64) -> Vec<f64> {
    let pairs = values.iter().zip(from);
    pairs.map(|(to, from)| (to - from) / step).collect()
}
