//! The run of a wheel along its track, and its averages.
//!
//! # Layout
//! - `balance`: the height of the hub at which the soil carries the load.
//! - `track`: the terrain a run needs, and the size of its steps.
//! - `rolling`: one step after the other.
//! - `effects`: effects on the run.
//! - `history`: the time histories of a run.
//! - `result`: the result of a run.
//! - `record`: the results of the steps, their averages and their checks.
//! - `protocol`: when a run ends, and which steps are averaged.
//! - `series`: the limit that averages approach.

mod balance;
mod effects;
mod history;
mod protocol;
mod record;
mod result;
mod rolling;
mod series;
mod track;

pub use history::History;
pub(crate) use protocol::roll;
pub use result::SpatialRun;
