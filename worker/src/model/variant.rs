//! A compiled variant: its built-in or external model.

use std::sync::Arc;

use scm::Averages;
use scm::spatial::SpatialRun;
use shared::exchange::RepeatedAnswer;
use shared::model::ModelVariant;
use shared::outcome::{Outcome, ParameterRejection};

use super::error::CompileError;
use super::external::OutsideModel;
use super::forward::ForwardModel;
use super::shared_time::SharedTime;
use crate::external::allowed::AllowedModels;

/// A variant ready to evaluate.
#[derive(Debug)]
pub struct CompiledVariant(Model);

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
        Ok(CompiledVariant(match &variant.external {
            None => Model::Ours(Box::new(ForwardModel::new(variant)?)),
            Some(description) => Model::Outside(Box::new(OutsideModel::new(variant, description, models)?)),
        }))
    }

    /// Returns the number of conditions of an evaluation.
    pub fn runs(&self) -> usize {
        match &self.0 {
            Model::Ours(forward) => forward.runs(),
            Model::Outside(model) => model.runs(),
        }
    }

    /// Simulates every condition at one parameter vector; the first rejection ends it.
    pub fn evaluate(&self, theta: &[f64]) -> Outcome {
        self.evaluate_and_keep(theta, |_| {})
    }

    /// Evaluates like [`CompiledVariant::evaluate`], with the same bits; the threads of the pool that calls share the conditions of a model
    /// whose runs take milliseconds. `time` is that of all threads.
    pub fn evaluate_with_idle_threads(&self, theta: &[f64], time: &SharedTime) -> Outcome {
        match &self.0 {
            Model::Ours(forward) => forward.evaluate(theta, Some(time), |_| {}),
            Model::Outside(model) => model.evaluate(theta),
        }
    }

    /// Evaluates like [`CompiledVariant::evaluate`]; `keep` receives each run of a time-dependent model, in the order of the conditions.
    pub fn evaluate_and_keep(&self, theta: &[f64], keep: impl FnMut(SpatialRun)) -> Outcome {
        match &self.0 {
            Model::Ours(forward) => forward.evaluate(theta, None, keep),
            Model::Outside(model) => model.evaluate(theta),
        }
    }

    /// Simulates every condition at one parameter vector; a rejection of one does not affect the rest.
    pub fn each(&self, theta: &[f64]) -> Vec<Result<Averages, ParameterRejection>> {
        match &self.0 {
            Model::Ours(forward) => forward.evaluate_each(theta),
            Model::Outside(model) => vec![Err(model.no_single_runs()); model.runs()],
        }
    }

    /// Asks an external model the same question again, and returns the difference of the answers; the built-in models repeat
    /// bit for bit.
    pub fn repeat(&self, theta: &[f64], first: &Outcome) -> Option<RepeatedAnswer> {
        match (&self.0, first) {
            (Model::Outside(model), Outcome::Evaluated(observables)) => model.repeat(theta, observables),
            _ => None,
        }
    }
}
