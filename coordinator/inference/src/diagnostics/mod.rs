//! Summarise draws and predictions by pure functions on slices.
//!
//! An empty slice has no mean: such questions answer `None`.
//!
//! # Layout
//! - `moments`, `quantile`, `ess`: draws of one parameter.
//! - `spectrum`: combinations of parameters that the data know best and worst.
//! - `conflict`: prior against posterior.
//! - `density`, `joint_density`: kernel densities, and the levels that hold most of a sample.
//! - `predicted_draw`: draws with their predictions. `information`: what a channel can say. `residual`: what the fit leaves,
//!   one by one and in sum. `trend`: whether it follows a condition.
//! - `region`: where in the prior failures concentrate.
//! - `tail`: probabilities of tests.

mod conflict;
mod density;
mod ess;
mod information;
mod joint_density;
mod moments;
mod predicted_draw;
mod quantile;
mod region;
mod residual;
mod spectrum;
mod tail;
mod trend;

pub use conflict::{Conflict, conflict};
pub use density::{bandwidth, density};
pub use ess::{kish_ess, rank_correlation, weight_cov};
pub use information::{ChannelSignal, signals};
pub use joint_density::{highest_density_levels, joint_density};
pub use moments::{mean, mean_and_sd};
pub use predicted_draw::PredictedDraw;
pub use quantile::{DrawSummary, quantile, summary};
pub use region::{BINS, Region, Side, bin, concentration};
pub use residual::{Residual, ResidualChiSquare, chi_square, residuals};
pub use spectrum::{Direction, principal_directions};
pub use tail::chi_square_tail;
pub use trend::{Trend, TrendTest};
