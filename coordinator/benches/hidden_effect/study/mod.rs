//! Trials of the search on synthetic experiments.
//!
//! # Layout
//! - `kind`: what is hidden; `laws`: laws outside the library. `trial`: one experiment, drawn and searched.
//! - `design`: the runs of the rig and their files. `case`: a truth and its measurements.
//! - `local_search`: the search on this thread; `record`: what a study would store of it. `noise_free`: how well the data determine the truth. `held_out`: prediction of unseen runs.
//! - `score`: the result of a trial; `line`: in one line.
//! - `posterior`: a calibration on this thread.
//! - `rate`: shares with their uncertainty. `target`: a line of the table; `tally`: the table.
//! - `parallel`: trials on all threads. `cpu`: their processor time. `error`: why one cannot be made.

pub(crate) mod case;
pub(crate) mod cpu;
pub(crate) mod design;
pub(crate) mod error;
mod held_out;
pub(crate) mod kind;
mod laws;
mod line;
pub(crate) mod local_search;
pub(crate) mod noise_free;
pub(crate) mod parallel;
pub(crate) mod posterior;
pub(crate) mod rate;
pub(crate) mod record;
pub(crate) mod score;
pub(crate) mod tally;
mod target;
pub(crate) mod trial;
