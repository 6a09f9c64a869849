//! The coordinator: it runs calibrations on a farm of workers and keeps the results.
//!
//! # Layout
//! - [`study`]: the growth of a study: its lineage and its next step.
//! - [`service`]: store and farm together: submit, recover, control, grow.
//! - [`webhook`]: the messages that are posted when a calibration pauses or ends.
//! - [`http`]: the REST interface. No other module uses axum.
//! - [`example`]: the built-in examples.
//! - [`effect`]: the effects as users see them: cards and signatures.
//! - [`schema`]: schemas of the files that people write.
//! - [`scale`]: how many workers Slurm, HyperQueue or Kubernetes should run, and the calls of their programs.
//! - [`embedded`]: local workers in this process. No other module uses the crate `worker`.
//! - [`pilot`]: a smaller calibration in this process, from which the cost of a job is estimated.
//! - [`command`]: the verbs of the command line.
//! - [`config`]: command line and environment.

#![expect(
    missing_docs,
    reason = "only this package's program and benchmarks use the library; messages of errors explain their fields"
)]

pub mod command;
pub mod config;
pub mod effect;
pub mod embedded;
pub mod example;
pub mod http;
pub mod pilot;
pub mod scale;
pub mod schema;
pub mod service;
pub mod study;
pub mod webhook;
