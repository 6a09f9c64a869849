//! External models: programs and UM-Bridge servers that the worker's operator allows.
//!
//! # Layout
//! - [`allowed`]: the models that this worker may run, and the identity of each.
//! - `program`: a program with JSON input; `group`: its processes, within limits. `umbridge`: a model of a UM-Bridge server.
//! - `answer`: their answers as numbers. `failure`: their failures.

pub mod allowed;
mod answer;
mod failure;
mod group;
mod program;
mod umbridge;

pub(crate) use failure::ExternalFailure;

/// Header of the answer to `/Info` in which a server may state the version of its models.
pub(crate) const MODEL_VERSION: &str = "model-version";

/// The input of an external model for one run: properties and parameters, in the model's order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ExternalRun {
    pub(crate) inputs: Vec<f64>,
    pub(crate) parameters: Vec<f64>,
}
