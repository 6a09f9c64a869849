//! Results of a study's searches for missing effects.
//!
//! # Layout
//! - `numerical_noise`: the scatter of the model that a search measured.
//! - `round`: a finished search, its effect file and its command.
//! - `summary`: the block `discovery` of `summary.json`.

mod numerical_noise;
mod round;
mod summary;

pub use numerical_noise::numerical_noise;
pub use round::{DiscoveryRound, effect_file, effect_files, law_files};
pub use round::{arguments, word};
pub use summary::DiscoverySummary;
