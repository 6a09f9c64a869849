//! Summarise draws and predictions by pure functions on slices.
//!
//! An empty slice has no mean: such questions answer `None`.
//!
//! # Layout
//! - `moments`, `quantile`, `ess`: draws of one parameter.
//! - `spectrum`: combinations of parameters that the data know best and worst.
//! - `conflict`: prior against posterior.
//! - `density`, `density_of_pairs`: kernel densities, and the levels that hold most of a sample.
//! - `predicted`: draws with their predictions. `information`: what a channel can say. `residual`: what the fit leaves,
//!   one by one and in sum. `trend`: whether it follows a condition.
//! - `region`: where in the prior failures concentrate.
//! - `tail`: probabilities of tests.

mod conflict;
mod density;
mod density_of_pairs;
mod ess;
mod information;
mod moments;
mod predicted;
mod quantile;
mod region;
mod residual;
mod spectrum;
mod tail;
mod trend;

pub use conflict::{Conflict, conflict};
pub use density::{bandwidth, density};
pub use density_of_pairs::{density_of_pairs, highest_density_levels};
pub use ess::{kish_ess, rank_correlation, weight_cov};
pub use information::{Signal, signals};
pub use moments::{mean, mean_and_sd};
pub use predicted::Predicted;
pub use quantile::{Summary, quantile, summary};
pub use region::{BINS, Region, Side, bin, concentration};
pub use residual::{ChiSquare, Residual, chi_square, residuals};
pub use spectrum::{Direction, principal_directions};
pub use tail::chi_square_tail;
pub use trend::{Trend, TrendTest};
