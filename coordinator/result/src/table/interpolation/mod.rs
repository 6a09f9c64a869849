//! Interpolation of the fitted measurements without physics: the baseline that a model should beat.
//!
//! - `interpolations`: all values of an experiment. `interpolated`: one value.
//! - `along_slip`: a cubic between runs that differ in slip only. `surface`: a Gaussian process over all conditions that vary.

mod along_slip;
mod interpolated;
mod interpolations;
mod surface;

pub use interpolated::InterpolatedOver;
pub use interpolations::Interpolations;
