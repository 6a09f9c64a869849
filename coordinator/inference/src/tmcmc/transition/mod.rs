//! The transition from the pool of one stage to the chains of the next.
//!
//! # Layout
//! - `schedule`: the next exponent. `weights`: the incremental weights. `resample`: systematic resampling.
//! - `ching_chen`: the chains of the original sampler. `next_stage`: the stage that they lead to.

mod ching_chen;
mod next_stage;
mod resample;
mod schedule;
mod weights;

pub(super) use next_stage::{Passage, Transition, tooth};
pub(crate) use resample::systematic;
pub(super) use weights::Weights;
