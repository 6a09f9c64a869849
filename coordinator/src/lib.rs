//! The coordinator: runs calibrations on a farm of workers and keeps what comes out.
//!
//! # Layout
//! - [`calibration`]: a calibration in progress: the one place where sampler, likelihood and leases meet. Pure.
//! - [`lease`]: the rules of leasing. Pure.
//! - [`farm`]: all calibrations and workers at hand; [`farm::dispatch`] gives it a thread.
//! - [`store`]: an SQLite file or a PostgreSQL database; the only place that knows SQL.
//! - [`study`]: how a study grows: its next step from where it stands.
//! - [`service`]: store and farm together: submit, recover, control, grow.
//! - [`webhook`]: what is posted when a calibration pauses or ends.
//! - [`token`]: bearer tokens and their roles.
//! - [`http`]: the REST interface; the only place that knows axum.
//! - [`missing_effect`]: the search for a missing effect: candidates, and what is said in the end.
//! - [`example`]: the examples that the program carries.
//! - [`effect`]: the effects as users meet them: cards and signatures.
//! - [`schema`]: schemas of the files that people write.
//! - [`scale`]: how many workers Slurm, HyperQueue or Kubernetes should run, and how they are told.
//! - [`embedded`]: local workers in this process; the only place that knows the worker.
//! - [`command`]: the verbs of the command line.
//! - [`config`]: command line and environment.

pub mod calibration;
pub mod command;
pub mod config;
pub mod effect;
pub mod embedded;
pub mod example;
pub mod farm;
pub mod http;
pub mod lease;
pub mod missing_effect;
pub mod scale;
pub mod schema;
pub mod service;
pub mod store;
pub mod study;
pub mod token;
pub mod webhook;
