//! The results of a study's searches for a missing effect.
//!
//! # Layout
//! - `numerical_noise`: what a search says of the scatter of the model.
//! - `round`: a finished search, its words and its command.
//! - `summary`: the block `discovery` of `summary.json`.

mod numerical_noise;
mod round;
mod summary;

pub use numerical_noise::numerical_noise;
pub use round::{DiscoveryRound, effect_file};
pub use round::{arguments, word};
pub use summary::DiscoverySummary;
