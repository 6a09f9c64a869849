//! The coordinator: runs calibrations on a farm of workers and keeps what comes out.
//!
//! # Layout
//! - [`study`]: how a study grows: its next step from where it stands.
//! - [`service`]: store and farm together: submit, recover, control, grow.
//! - [`webhook`]: what is posted when a calibration pauses or ends.
//! - [`http`]: the REST interface; the only place that knows axum.
//! - [`example`]: the examples that the program carries.
//! - [`effect`]: the effects as users meet them: cards and signatures.
//! - [`schema`]: schemas of the files that people write.
//! - [`scale`]: how many workers Slurm, HyperQueue or Kubernetes should run, and how they are told.
//! - [`embedded`]: local workers in this process; the only place that knows the worker.
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
pub mod scale;
pub mod schema;
pub mod service;
pub mod study;
pub mod webhook;
