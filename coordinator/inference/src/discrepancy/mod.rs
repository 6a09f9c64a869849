//! The discrepancy of a model, as a process over the conditions of the rig.
//!
//! - `misfit`: measured minus model in one condition. `process`: the discrepancy there and between.
//! - `covariance`: the covariance of two conditions. `posterior`: the posterior of its parameters.

mod covariance;
mod misfit;
mod posterior;
mod process;

pub use misfit::Misfit;
pub use process::{Discrepancy, DiscrepancyComponent, DiscrepancyProcess};
