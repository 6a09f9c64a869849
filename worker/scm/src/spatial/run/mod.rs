//! Roll the wheel along its track and average what it feels.
//!
//! # Layout
//! - `balance`: the height of the hub at which the soil carries the load.
//! - `track`: the terrain a run needs, and the size of its steps.
//! - `rolling`: one step after the other.
//! - `effects`: what effects change of it.
//! - `history`: what each step gave.
//! - `result`: what a run gives.
//! - `record`: what the steps gave, its averages, and whether they can be.
//! - `protocol`: when a run ends, and which steps are averaged.

mod balance;
mod effects;
mod history;
mod protocol;
mod record;
mod result;
mod rolling;
mod track;

pub use history::History;
pub(crate) use protocol::roll;
pub use result::SpatialRun;
