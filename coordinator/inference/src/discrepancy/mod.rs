//! What a model misses, as a process over the conditions of the rig.
//!
//! - `misfit`: measured minus model in one condition. `process`: the discrepancy there and between.
//! - `covariance`: how the discrepancies of two conditions vary together. `posterior`: its parameters, as probable as the misfits make
//!   them.

mod covariance;
mod misfit;
mod posterior;
mod process;

pub use misfit::Misfit;
pub use process::{Discrepancy, DiscrepancyComponent, DiscrepancyProcess};
