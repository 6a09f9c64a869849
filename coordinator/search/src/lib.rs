//! The search for a missing effect on the farm: its models as jobs, and its result in names and sentences.
//!
//! # Layout
//! - [`candidate`]: candidate effects as additions to a job, and those of the library. `law`: laws outside the library as effect
//!   files.
//! - `candidate_file`: candidates that come with the job as effect files.
//! - [`untried`]: effects that need a property which the experiment does not state.
//! - `models`: the models of a search, made when they are queried. `entry`: their candidates. `reduced_model`: the base without one of its effects. `family`: candidates that are tried
//!   together. `design`: levels of the design, and runs that the rig could make.
//! - `search`: a search in progress, as leases take it. `answers`: what the model has answered already.
//! - `discovery_record`: its result as it is stored. `curves`: the predictions of its explanations. `narrative`: its verdict in one
//!   sentence. `remaining_misfit`: the misfit that remains. `rig_errors`: errors that sessions and tarings share.
//! - `bench_measurement`: measurements without a rolling wheel that distinguish explanations.

mod answers;
mod bench_measurement;
pub mod candidate;
mod candidate_file;
mod curves;
mod design;
mod discovery_record;
mod entry;
mod family;
#[cfg(test)]
mod fixture;
mod law;
mod models;
mod narrative;
mod reduced_model;
mod remaining_misfit;
mod rig_errors;
mod search;
pub mod untried;

pub use models::SearchModels;
pub use search::{DiscoveryError, RunningDiscovery};
