//! The quasi-static model as low-fidelity model of the three-dimensional one: predicted values for a metamodel, and its subchains.

use shared::model::ModelVariant;
use shared::outcome::Outcome;
use shared::predicted::PredictedValue;
use statistics::Metamodel;

use super::error::CompileError;
use super::forward::ForwardModel;

/// A variant's low-fidelity model, ready to evaluate.
#[derive(Debug)]
pub(super) struct CompiledLowFidelity {
    coarse: ForwardModel,
    values: Vec<PredictedValue>,
    pub(super) metamodel: Option<Metamodel>,
}

impl CompiledLowFidelity {
    /// Returns the low-fidelity model of a variant; `None` if it has none. [`CompileError`] names what the quasi-static
    /// model cannot express.
    pub(super) fn new(variant: &ModelVariant) -> Result<Option<Self>, CompileError> {
        let Some(low_fidelity) = &variant.low_fidelity else {
            return Ok(None);
        };
        Ok(Some(Self {
            coarse: ForwardModel::new(&variant.coarse()?)?,
            values: low_fidelity.values.clone(),
            metamodel: low_fidelity.metamodel.as_deref().cloned(),
        }))
    }

    /// Returns the quasi-static model's predicted values; `None` if it rejects the parameters.
    pub(super) fn values(&self, theta: &[f64]) -> Option<Vec<f64>> {
        match self.coarse.evaluate(theta, |_| {}) {
            Outcome::Evaluated(observables) => Some(
                self.values
                    .iter()
                    .map(|value| value.select(&observables))
                    .collect(),
            ),
            Outcome::Rejected(_) | Outcome::Fault(_) => None,
        }
    }
}
