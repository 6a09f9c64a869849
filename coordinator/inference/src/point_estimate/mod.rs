//! The common parts of all point estimates: the axes and the result.
//!
//! The maximised function is ln p(data | theta) + ln p(theta), the second term the density of the parameters as declared: another
//! parametrisation of the same prior (a lognormal x, a normal ln x) has another maximum.
//!
//! # Layout
//! - `axis`: one parameter in units of its prior's width. `mode`: the result.

mod axis;
mod mode;

pub(crate) use axis::PriorAxis;
pub use mode::{Generation, Laplace, ModeEstimate, NormalApproximation, StopReason};
