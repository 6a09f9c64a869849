//! A stateless worker: it fetches parameter vectors, simulates, and posts observables.
//!
//! # Layout
//! - [`model`]: a variant compiled for evaluation.
//! - [`external`]: external models that the operator allows.
//! - [`evaluator`]: a pool of threads that evaluates leases and counts the time it simulates.
//! - [`pull`]: the loop of a worker: exchange, evaluate, resend, renew, give back.
//! - [`client`]: HTTP client of the coordinator.
//! - [`simulate`]: forward runs of an experiment without a coordinator.
//! - [`serve`]: the built-in models by UM-Bridge.
//! - [`processor`]: the check that this machine can run the build.
//! - [`program`]: the command line, executed.
//! - [`config`]: command line and environment. [`shell`]: completions and man pages.

pub mod client;
pub mod config;
pub mod evaluator;
pub mod external;
#[cfg(test)]
mod fixture;
pub mod model;
pub mod processor;
pub mod program;
pub mod pull;
pub mod serve;
pub mod shell;
pub mod simulate;

/// Returns the version of the equations that this worker computes.
pub fn model_version() -> &'static str {
    scm::MODEL_VERSION
}
