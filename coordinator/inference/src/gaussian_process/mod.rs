//! Interpolation of measurements over several conditions by a Gaussian process.
//!
//! - `observation`: a measurement. `process`: the process and its mean between the measurements.
//! - `smoothness`: length scales and noise, chosen by leaving out one measurement after the other. `representative`: the
//!   measurements that determine them. `kernel`: covariances. `unit_range`: coordinates over their range.

mod kernel;
mod observation;
mod process;
mod representative;
mod smoothness;
mod unit_range;

pub(crate) use kernel::matern;
pub use observation::Observation;
pub use process::GaussianProcess;
pub(crate) use representative::representative;
pub(crate) use unit_range::UnitRange;
