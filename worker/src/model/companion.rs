//! The quasi-static model beside the three-dimensional one: what a metamodel compares, and its subchains.

use shared::model::ModelVariant;
use shared::outcome::{Fault, Observables, Outcome};
use shared::predicted::Predicted;
use statistics::{Metamodel, Subchain, SubchainEnd};

use super::CompiledVariant;

/// A variant's companion, ready to evaluate.
#[derive(Debug)]
pub(super) struct CompiledCompanion {
    coarse: CompiledVariant,
    values: Vec<Predicted>,
    metamodel: Option<Metamodel>,
}

impl CompiledCompanion {
    /// The companion of a variant; `None` where it has none.
    ///
    /// # Errors
    /// A sentence that names what the quasi-static model cannot express.
    pub(super) fn new(variant: &ModelVariant) -> Result<Option<Box<Self>>, String> {
        let Some(companion) = &variant.companion else {
            return Ok(None);
        };
        Ok(Some(Box::new(Self {
            coarse: CompiledVariant::new(&variant.coarse()?)?,
            values: companion.values.clone(),
            metamodel: companion.metamodel.as_deref().cloned(),
        })))
    }

    /// The quasi-static model's predicted values; `None` where it refuses.
    fn values(&self, theta: &[f64]) -> Option<Vec<f64>> {
        match self.coarse.evaluate(theta) {
            Outcome::Evaluated(observables) => {
                Some(self.values.iter().map(|value| value.of(&observables)).collect())
            }
            Outcome::Rejected(_) | Outcome::Fault(_) => None,
        }
    }

    /// Adds the quasi-static model's predicted values to observables of the same parameters.
    pub(super) fn add(&self, theta: &[f64], observables: &mut Observables) {
        observables.coarse = self.values(theta);
    }
}

impl CompiledVariant {
    /// Evaluates what a lease asks for: the model at `theta`, or at the end of a subchain that starts there, unless that
    /// stayed where it was.
    pub fn serve(
        &self,
        theta: &[f64],
        subchain: Option<&Subchain>,
    ) -> (Option<Outcome>, Option<SubchainEnd>) {
        let Some(subchain) = subchain else {
            return (Some(self.evaluate(theta)), None);
        };
        let fault = |message: String| (Some(Outcome::Fault(Fault { message })), None);
        let companion = self.companion.as_deref();
        let Some((companion, metamodel)) = companion.and_then(|c| Some((c, c.metamodel.as_ref()?))) else {
            return fault("a subchain was asked of a variant without a metamodel".into());
        };
        if theta.len() < self.dimension {
            let (given, needed) = (theta.len(), self.dimension);
            return fault(format!("theta has {given} entries, the variant has {needed}"));
        }
        let model = |theta: &[f64]| theta[..self.dimension].to_vec();
        match metamodel.run(subchain, theta, |theta| companion.values(&model(theta))) {
            Ok(end) if end.accepted == 0 => (None, Some(end)),
            Ok(end) => (Some(self.evaluate(&model(&end.theta))), Some(end)),
            Err(error) => fault(format!("the metamodel: {error}")),
        }
    }
}
