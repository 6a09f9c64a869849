//! The numbers of the figures.
//!
//! # Layout
//! - `history`: measured and simulated histories, filtered.

mod history;

pub use history::{ChannelHistory, ModelSeries, Series};
