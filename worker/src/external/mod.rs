//! Models that are not ours: programs and UM-Bridge servers that the worker's operator allows.
//!
//! # Layout
//! - [`allowed`]: which of them this worker runs, and the identity of each.
//! - `program`: a program, fed with JSON; `group`: its processes, within limits. `umbridge`: a model of a UM-Bridge server.
//! - `answer`: what both answer, in numbers. `failure`: why they give none.

pub mod allowed;
mod answer;
mod failure;
mod group;
mod program;
mod umbridge;

pub(crate) use failure::ExternalFailure;

/// Header of the answer to `/Info` by which a server may tell the version of its models.
pub(crate) const MODEL_VERSION: &str = "model-version";

/// A run as a model that is not ours is given it: its properties and the parameters, in the model's order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ExternalRun {
    pub(crate) inputs: Vec<f64>,
    pub(crate) parameters: Vec<f64>,
}
