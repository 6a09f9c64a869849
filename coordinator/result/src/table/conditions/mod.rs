//! The conditions of the rig in which runs differ.
//!
//! - `axis`: a condition as a coordinate. `varied`: the conditions that a set of runs varies.

mod axis;
mod varied;

pub(crate) use axis::{ALIKE_LOADS, Axis};
pub(crate) use varied::{Conditions, repeated};
