//! The quasi-static model beside the three-dimensional one: what a metamodel compares, and its subchains.

use shared::model::ModelVariant;
use shared::outcome::Outcome;
use shared::predicted::PredictedValue;
use statistics::Metamodel;

use super::error::CompileError;
use super::forward::ForwardModel;

/// A variant's companion, ready to evaluate.
#[derive(Debug)]
pub(super) struct CompiledCompanion {
    coarse: ForwardModel,
    values: Vec<PredictedValue>,
    pub(super) metamodel: Option<Metamodel>,
}

impl CompiledCompanion {
    /// The companion of a variant; `None` where it has none.
    ///
    /// # Errors
    /// [`CompileError`] names what the quasi-static model cannot express.
    pub(super) fn new(variant: &ModelVariant) -> Result<Option<Self>, CompileError> {
        let Some(companion) = &variant.companion else {
            return Ok(None);
        };
        Ok(Some(Self {
            coarse: ForwardModel::new(&variant.coarse()?)?,
            values: companion.values.clone(),
            metamodel: companion.metamodel.as_deref().cloned(),
        }))
    }

    /// The quasi-static model's predicted values; `None` where it refuses.
    pub(super) fn values(&self, theta: &[f64]) -> Option<Vec<f64>> {
        match self.coarse.evaluate(theta, |_| {}) {
            Outcome::Evaluated(observables) => {
                Some(self.values.iter().map(|value| value.of(&observables)).collect())
            }
            Outcome::Rejected(_) | Outcome::Fault(_) => None,
        }
    }
}
