//! A compiled variant: its forward model, and the low-fidelity model of a metamodel.

use std::sync::Arc;

use scm::Averages;
use scm::spatial::SpatialRun;
use shared::exchange::RepeatedAnswer;
use shared::model::ModelVariant;
use shared::outcome::{Fault, Outcome, ParameterRejection};
use statistics::{Subchain, SubchainEnd};

use super::error::CompileError;
use super::external::OutsideModel;
use super::forward::ForwardModel;
use super::low_fidelity::CompiledLowFidelity;
use crate::external::allowed::AllowedModels;

/// A variant ready to evaluate.
#[derive(Debug)]
pub struct CompiledVariant {
    model: Model,
    /// The low-fidelity model for a metamodel, if there is one.
    low_fidelity: Option<CompiledLowFidelity>,
}

/// The built-in or external model of a variant.
#[derive(Debug)]
enum Model {
    Ours(Box<ForwardModel>),
    Outside(Box<OutsideModel>),
}

impl CompiledVariant {
    /// Resolves the names of a variant; `models` are the external models that may be run. [`CompileError`] names what this
    /// worker does not know or cannot express.
    pub fn new(variant: &ModelVariant, models: &Arc<AllowedModels>) -> Result<Self, CompileError> {
        let model = match &variant.external {
            None => Model::Ours(Box::new(ForwardModel::new(variant)?)),
            Some(description) => Model::Outside(Box::new(OutsideModel::new(variant, description, models)?)),
        };
        Ok(CompiledVariant {
            model,
            low_fidelity: CompiledLowFidelity::new(variant)?,
        })
    }

    /// Returns the number of conditions of an evaluation.
    pub fn runs(&self) -> usize {
        match &self.model {
            Model::Ours(forward) => forward.runs(),
            Model::Outside(model) => model.runs(),
        }
    }

    /// Simulates every condition at one parameter vector; the first rejection ends it.
    pub fn evaluate(&self, theta: &[f64]) -> Outcome {
        self.evaluate_and_keep(theta, |_| {})
    }

    /// Evaluates like [`CompiledVariant::evaluate`]; `keep` receives each run of a time-dependent model, in the order of the conditions.
    pub fn evaluate_and_keep(&self, theta: &[f64], keep: impl FnMut(SpatialRun)) -> Outcome {
        let mut outcome = match &self.model {
            Model::Ours(forward) => forward.evaluate(theta, keep),
            Model::Outside(model) => model.evaluate(theta),
        };
        if let (Outcome::Evaluated(observables), Some(low_fidelity)) = (&mut outcome, &self.low_fidelity) {
            observables.coarse = low_fidelity.values(theta);
        }
        outcome
    }

    /// Simulates every condition at one parameter vector; a rejection of one does not affect the rest.
    pub fn each(&self, theta: &[f64]) -> Vec<Result<Averages, ParameterRejection>> {
        match &self.model {
            Model::Ours(forward) => forward.evaluate_each(theta),
            Model::Outside(model) => vec![Err(model.no_single_runs()); model.runs()],
        }
    }

    /// Asks an external model the same question again, and returns the difference of the answers; the built-in models repeat
    /// bit for bit.
    pub fn repeat(&self, theta: &[f64], first: &Outcome) -> Option<RepeatedAnswer> {
        match (&self.model, first) {
            (Model::Outside(model), Outcome::Evaluated(observables)) => model.repeat(theta, observables),
            _ => None,
        }
    }

    /// Evaluates a lease: the model at `theta`, or at the end of a subchain that starts there. There is no outcome if the
    /// subchain did not move.
    pub fn serve(
        &self,
        theta: &[f64],
        subchain: Option<&Subchain>,
    ) -> (Option<Outcome>, Option<SubchainEnd>) {
        let Some(subchain) = subchain else {
            return (Some(self.evaluate(theta)), None);
        };
        let fault = |message: String| (Some(Outcome::Fault(Fault { message })), None);
        let Model::Ours(forward) = &self.model else {
            return fault("a subchain was asked of a model that is not ours".into());
        };
        let compiled = self.low_fidelity.as_ref();
        let with_metamodel = compiled.and_then(|model| Some((model, model.metamodel.as_ref()?)));
        let Some((coarse, metamodel)) = with_metamodel else {
            return fault("a subchain was asked of a variant without a metamodel".into());
        };
        if theta.len() < forward.dimension {
            let (given, needed) = (theta.len(), forward.dimension);
            return fault(format!("theta has {given} entries, the variant has {needed}"));
        }
        // the sampler's vector has the noise parameters after those of the model
        let model_part = |theta: &[f64]| theta[..forward.dimension].to_vec();
        match metamodel.run(subchain, theta, |theta| coarse.values(&model_part(theta))) {
            Ok(end) if end.accepted == 0 => (None, Some(end)),
            Ok(end) => (Some(self.evaluate(&model_part(&end.theta))), Some(end)),
            Err(error) => fault(format!("the metamodel: {error}")),
        }
    }
}
