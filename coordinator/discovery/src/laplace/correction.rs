//! The companion of a model as a control variate of derivatives.

/// By how much a derivative of the model exceeds that of its companion.
#[derive(Debug, Clone)]
pub(crate) struct Correction {
    pub(crate) beyond: Vec<f64>,
    /// Over a long step of the screen: good for steps of a fit, not for an evidence.
    pub(crate) is_secant: bool,
}

impl Correction {
    /// As if the model changed as its companion does, which a fit has to measure.
    pub(crate) fn none(values: usize) -> Self {
        Self {
            beyond: vec![0.0; values],
            is_secant: true,
        }
    }

    /// Of a derivative of the model and the companion's over the same step.
    pub(crate) fn between(model: &[f64], companion: &[f64], is_secant: bool) -> Self {
        let pairs = model.iter().zip(companion);
        Self {
            beyond: pairs.map(|(model, companion)| model - companion).collect(),
            is_secant,
        }
    }

    /// The model's derivative where the companion has this one.
    pub(crate) fn of_model(&self, companion: &[f64]) -> Vec<f64> {
        let pairs = companion.iter().zip(&self.beyond);
        pairs.map(|(companion, beyond)| companion + beyond).collect()
    }
}

/// The difference quotient of predicted values over a step of one coordinate.
pub(crate) fn quotient(values: &[f64], from: &[f64], step: f64) -> Vec<f64> {
    let pairs = values.iter().zip(from);
    pairs.map(|(to, from)| (to - from) / step).collect()
}
