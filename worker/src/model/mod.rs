//! A model variant, compiled for evaluation.
//!
//! # Layout
//! - `variant`: [`CompiledVariant`], a built-in or external model; `cache`: the compiled variants in memory.
//! - `forward`: the forward model; `physics`: its equations; `spatial`: the settings of the three-dimensional one;
//!   `bevameter`: plates and rings. `shared_time`: the time of conditions that threads share.
//! - `external`: an external model, with the effects around it.
//! - `error`: errors of compiling a variant.
//! - `effects`: the effects, compiled, with the sources of their parameters.
//! - `parameters`: the source of each physical quantity.
//! - `recording`: the time histories of a run, at 10 Hz; `transients`: the points before it is steady, by run.

mod bevameter;
mod cache;
mod effects;
mod error;
mod external;
mod forward;
mod parameters;
mod physics;
mod recording;
mod shared_time;
mod spatial;
mod transients;
mod variant;

pub use bevameter::{CompiledBevameter, Readings, without_action};
pub use cache::VariantCache;
pub use error::CompileError;
pub use recording::at_10_hz;
pub use shared_time::SharedTime;
pub use variant::CompiledVariant;
