//! The vocabulary that coordinator and worker share, and the wire between them.
//!
//! # Layout
//! - [`channel`]: what a test rig measures: drawbar pull, torque, sinkage, lateral force.
//! - [`limit`]: which values a quantity can have, and which are usual.
//! - [`parameters`]: the names, units and physical bounds of the parameters.
//! - [`experiment`]: an experiment as its files describe it: wheels, rig, noise, protocol, test runs.
//! - [`model`]: which forward model is meant ([`model::ModelSettings`]) and the self-contained
//!   [`model::ModelVariant`] that a worker evaluates.
//! - [`outcome`]: the outcome of an evaluation: observables, a rejection of the parameters, or a fault.
//! - [`predicted`]: which of the observables a likelihood takes.
//! - [`exchange`]: the messages between worker and coordinator.
//! - [`wire`]: their two forms in bytes.
//! - [`api`]: the messages between a user and the service.
//! - [`bearer`]: the token that a client shows to the service.
//! - [`sentence`]: an error and its causes in one sentence.
//! - [`mod@file`]: files by name, and errors that name file, line and the nearest known word; `toml_message`: what is wrong with TOML.
//! - [`text_file`]: text files on disk.
//!
//! The crate only parses and validates: no clock, no network, no database.

pub mod api;
pub mod bearer;
pub mod channel;
pub mod exchange;
pub mod experiment;
pub mod file;
pub mod limit;
pub mod model;
pub mod outcome;
pub mod parameters;
pub mod predicted;
pub mod sentence;
pub mod text_file;
mod toml_message;
pub mod wire;
