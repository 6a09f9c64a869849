//! Hold what every search for the most probable parameters shares.
//!
//! Maximised is ln p(data | theta) + ln p(theta), the second term the density of the parameters as declared: another
//! way to write down the same prior (a lognormal x, a normal ln x) has another maximum.
//!
//! # Layout
//! - `axis`: one parameter in units of its prior's width. `space`: all of them.
//! - `individual`: an evaluated point. `estimate`: the result.

mod axis;
mod estimate;
mod individual;
mod space;

pub(crate) use axis::Axis;
pub use estimate::{Estimate, Generation, Laplace, Stop};
pub(crate) use individual::Individual;
pub(crate) use space::Space;
