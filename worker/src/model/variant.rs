//! A variant, compiled: its forward model, and the companion of a metamodel.

use scm::Averages;
use scm::spatial::SpatialRun;
use shared::model::ModelVariant;
use shared::outcome::{Fault, Outcome, ParameterRejection};
use statistics::{Subchain, SubchainEnd};

use super::companion::CompiledCompanion;
use super::error::CompileError;
use super::forward::ForwardModel;

/// A variant ready to evaluate.
#[derive(Debug)]
pub struct CompiledVariant {
    forward: ForwardModel,
    /// The quasi-static model for a metamodel, where there is one.
    companion: Option<CompiledCompanion>,
}

impl CompiledVariant {
    /// Resolves the names of a variant.
    ///
    /// # Errors
    /// [`CompileError`] names what this worker does not know or cannot express.
    pub fn new(variant: &ModelVariant) -> Result<Self, CompileError> {
        Ok(CompiledVariant {
            forward: ForwardModel::new(variant)?,
            companion: CompiledCompanion::new(variant)?,
        })
    }

    /// Number of conditions that an evaluation simulates.
    pub fn runs(&self) -> usize {
        self.forward.runs()
    }

    /// Simulates every condition at one parameter vector; the first rejection ends it.
    pub fn evaluate(&self, theta: &[f64]) -> Outcome {
        self.evaluate_and_keep(theta, |_| {})
    }

    /// The same, handing over each run of a model that rolls in time, in the order of the conditions.
    pub fn evaluate_and_keep(&self, theta: &[f64], keep: impl FnMut(SpatialRun)) -> Outcome {
        let mut outcome = self.forward.evaluate(theta, keep);
        if let (Outcome::Evaluated(observables), Some(companion)) = (&mut outcome, &self.companion) {
            observables.coarse = companion.values(theta);
        }
        outcome
    }

    /// Simulates every condition at one parameter vector; a rejection of one leaves the others.
    pub fn each(&self, theta: &[f64]) -> Vec<Result<Averages, ParameterRejection>> {
        self.forward.each(theta)
    }

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
        let companion = self.companion.as_ref();
        let Some((companion, metamodel)) = companion.and_then(|c| Some((c, c.metamodel.as_ref()?))) else {
            return fault("a subchain was asked of a variant without a metamodel".into());
        };
        if theta.len() < self.forward.dimension {
            let (given, needed) = (theta.len(), self.forward.dimension);
            return fault(format!("theta has {given} entries, the variant has {needed}"));
        }
        let model = |theta: &[f64]| theta[..self.forward.dimension].to_vec();
        match metamodel.run(subchain, theta, |theta| companion.values(&model(theta))) {
            Ok(end) if end.accepted == 0 => (None, Some(end)),
            Ok(end) => (Some(self.evaluate(&model(&end.theta))), Some(end)),
            Err(error) => fault(format!("the metamodel: {error}")),
        }
    }
}
