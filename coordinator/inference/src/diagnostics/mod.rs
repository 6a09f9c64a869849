//! Summarise draws and predictions by pure functions on slices.
//!
//! An empty slice has no mean: such questions answer `None`.

mod bound;
mod density;
mod density_of_pairs;
mod ess;
mod moments;
mod quantile;

pub use bound::at_bound;
pub use density::{bandwidth, density};
pub use density_of_pairs::{density_of_pairs, highest_density_levels};
pub use ess::{kish_ess, rank_correlation, weight_cov};
pub use moments::{mean, mean_and_sd};
pub use quantile::{Summary, quantile, summary};
