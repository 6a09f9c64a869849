//! Runs cut from one long recording.
//!
//! # Layout
//! - `knife`: the data of a cut. `segment`: the rows of each run.
//! - `history`: the series of a run at equal steps. `cut`: the runs with their averages and histories.

mod cut;
mod history;
mod knife;
mod segment;

pub(crate) use cut::cut;
pub(crate) use knife::Knife;
