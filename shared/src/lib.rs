//! The vocabulary that coordinator and worker share, and the wire between them.
//!
//! # Layout
//! - [`channel`]: the channels of a test rig: drawbar pull, torque, sinkage, lateral force.
//! - [`limit`]: the possible and the usual values of a quantity.
//! - [`parameters`]: the names, units and physical bounds of the parameters.
//! - [`experiment`]: an experiment with its files: wheels, rig, noise, protocol, test runs.
//! - [`model`]: the settings of a forward model ([`model::ModelSettings`]) and the self-contained [`model::ModelVariant`]
//!   that a worker evaluates.
//! - [`outcome`]: the outcome of an evaluation: observables, a rejection of the parameters, or a fault.
//! - [`predicted`]: the observables that a likelihood uses.
//! - [`exchange`]: the messages between worker and coordinator.
//! - [`wire`]: their two forms in bytes.
//! - [`api`]: the messages between a user and the service.
//! - [`bearer`]: the token that a client shows to the service.
//! - [`sentence`]: joins an error and its causes into one sentence.
//! - [`mod@file`]: files by name, and errors that name file, line and the nearest known word; `toml_message`: messages of
//!   TOML mistakes.
//! - [`text_file`]: text files on disk. [`keys`]: the keys of a table, as the struct that reads it states them.
//!
//! The crate only parses and validates: no clock, no network, no database.

pub mod api;
pub mod bearer;
#[cfg(test)]
mod case_table;
pub mod channel;
pub mod exchange;
pub mod experiment;
pub mod file;
pub mod keys;
pub mod limit;
pub mod model;
pub mod outcome;
pub mod parameters;
pub mod predicted;
pub mod sentence;
pub mod text_file;
mod toml_message;
pub mod wire;
