//! Summaries and tests of draws and predictions: pure functions on slices.
//!
//! An undefined value, such as the mean of an empty slice, is `None`.
//!
//! # Layout
//! - `moments`, `quantile`, `ess`: draws of one parameter.
//! - `spectrum`: the combinations of parameters that the data determine best and worst.
//! - `conflict`: prior-data conflict.
//! - `density`: kernel densities, and highest-density regions.
//! - `predicted_draw`: draws with their predictions. `information`: the prior signal of a channel. `residual`: studentised
//!   residuals and their chi-square. `trend`: trends of residuals with a regressor.
//! - `group_offsets`: offsets that groups of repeats share, beside the scatter of the repeats.
//! - `linear_dependence`: a quantity that is a linear function of others.
//! - `region`: where in the prior failures concentrate.
//! - `subset_shift`: the shift of parameters if some of the data were fitted alone.
//! - `tail`: tail probabilities of test statistics.

mod conflict;
mod density;
mod ess;
mod group_offsets;
mod information;
mod linear_dependence;
mod moments;
mod predicted_draw;
mod quantile;
mod region;
mod residual;
mod spectrum;
mod subset_shift;
mod tail;
mod trend;

pub use conflict::{Conflict, conflict};
pub use density::{bandwidth, density, highest_density_levels, joint_density};
pub use ess::{kish_ess, rank_correlation, weight_cov};
pub use group_offsets::{GroupOffset, GroupOffsets, NoGroupOffsets, group_offsets};
pub use information::{ChannelSignal, signals};
pub use linear_dependence::linear_dependence;
pub use moments::{mean, mean_and_sd};
pub use predicted_draw::PredictedDraw;
pub use quantile::{DrawSummary, quantile, summary};
pub use region::{BINS, Region, Side, bin, concentration};
pub use residual::{Residual, ResidualChiSquare, chi_square, residuals};
pub(crate) use spectrum::mean_and_covariance;
pub use spectrum::{Direction, principal_directions};
pub use subset_shift::{SubsetShift, derivatives_from_draws, subset_shift};
pub use tail::chi_square_tail;
pub use trend::{Trend, TrendTest};
