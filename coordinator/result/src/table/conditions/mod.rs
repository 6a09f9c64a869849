//! The conditions of the rig in which runs differ.
//!
//! - `axis`: one of them as a coordinate. `varied`: those of some runs.

mod axis;
mod varied;

pub(crate) use axis::ALIKE_LOADS;
pub(crate) use varied::{Conditions, repeated};
