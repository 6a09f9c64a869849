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

pub mod case;
pub mod cpu;
pub mod design;
pub mod error;
pub mod held_out;
pub mod kind;
pub mod laws;
pub mod line;
pub mod local_search;
pub mod noise_free;
pub mod parallel;
pub mod posterior;
pub mod rate;
pub mod record;
pub mod score;
pub mod tally;
pub mod target;
pub mod trial;
