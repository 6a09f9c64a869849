//! Interpolation of the fitted measurements, without physics: what a model should beat.
//!
//! - `interpolations`: of an experiment. `interpolated`: of one measurement.
//! - `along_slip`: between runs that differ in slip alone. `surface`: over all conditions that vary, by a Gaussian process.

mod along_slip;
mod interpolated;
mod interpolations;
mod surface;

pub use interpolated::InterpolatedOver;
pub use interpolations::Interpolations;
