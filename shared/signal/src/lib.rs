//! Turns a time history into the averages that are compared with measurements.
//!
//! # Layout
//! - [`mod@resample`]: steps of uneven length to intervals of equal length.
//! - [`low_pass`]: a filter without phase shift.
//! - [`mod@period_mean`]: the mean over a whole number of periods at the end of a window.
//! - [`mod@average`]: filter and mean by a protocol, for simulated and measured histories alike.
//! - `error`: errors of histories and settings.
//!
//! A history is a sequence of means over intervals of equal length, as a rig's data logger records it and as
//! [`resample()`] computes it from a simulation. The caller provides the buffers; nothing allocates.
//! Steps and results depend on the arguments alone, bit for bit: sums run from the first sample to the last.

pub mod average;
mod error;
pub mod low_pass;
pub mod period_mean;
pub mod resample;

pub use average::average;
pub use error::SignalError;
pub use low_pass::LowPass;
pub use period_mean::{PeriodMean, SampledSignal, Window, period_mean};
pub use resample::{intervals, resample};

/// Interval of the rigs' recordings and of every simulated history `[s]`: 10 Hz.
pub const INTERVAL_S: f64 = 0.1;
