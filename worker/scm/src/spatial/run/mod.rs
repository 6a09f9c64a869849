//! The run of a wheel along its track, and its averages.
//!
//! # Layout
//! - `balance`: the height of the hub at which the soil carries the load.
//! - `track`: the terrain of a run, and the size of its steps.
//! - `rolling`: one step after another.
//! - `effects`: effects on the run.
//! - `history`: the time histories of a run.
//! - `result`: the result of a run.
//! - `record`: the results of the steps, their averages and their checks.
//! - `protocol`: the end of a run, and the averaged steps.
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
