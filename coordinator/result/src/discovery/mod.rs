//! The results of a study's searches for a missing effect.
//!
//! # Layout
//! - `round`: a finished search, its words and its command.
//! - `summary`: the block `discovery` of `summary.json`.

mod round;
mod summary;

pub use round::{DiscoveryRound, effect_file};
pub(crate) use round::{arguments, word};
pub use summary::DiscoverySummary;
