//! Interpolation of measurements over several conditions by a Gaussian process.
//!
//! - `observation`: a measurement. `process`: the process and its mean between the measurements.
//! - `smoothness`: length scales and noise, chosen by leaving out one measurement after the other. `kernel`: covariances.

mod kernel;
mod observation;
mod process;
mod smoothness;

pub use observation::Observation;
pub use process::GaussianProcess;
