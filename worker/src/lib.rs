//! A stateless worker: pulls parameter vectors, simulates, posts observables.
//!
//! # Layout
//! - [`model`]: a variant made ready to evaluate: shared names become the physics' types.
//! - [`evaluator`]: a pool of threads that evaluates leases and counts the time it simulates.
//! - [`pull`]: the loop of a worker: exchange, evaluate, resend, renew, give back.
//! - [`client`]: the coordinator over HTTP; the only place that knows HTTP.
//! - [`simulate`]: forward runs of an experiment without a coordinator.
//! - [`processor`]: whether this machine can run what was built.
//! - [`config`]: command line and environment.

pub mod client;
pub mod config;
pub mod evaluator;
pub mod model;
pub mod processor;
pub mod pull;
pub mod simulate;

/// Version of the equations that this worker computes.
pub fn model_version() -> &'static str {
    scm::MODEL_VERSION
}
