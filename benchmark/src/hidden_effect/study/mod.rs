//! Trials of the search on synthetic experiments.
//!
//! # Layout
//! - `kind`: the kinds of hidden effects; `laws`: laws outside the library. `draw`: truths of each kind. `trial`: one experiment, searched.
//! - `design`: the runs of the rig and their files; `wheel_size`: dimensions of the wheel; `geometry`: wrong statements of them. `noise`: noise of measurements.
//!   `case`: a truth and its measurements; `session`: the same in sessions of the rig.
//! - `local_search`: the search on one thread; `record`: the record that a study would store of it. `noise_free`: how well noise-free data
//!   determine the truth. `held_out`: prediction of unseen runs. `posterior`: draws of a calibration.
//! - `truth`: what is hidden; `statement`: what a search states about it. `score`: the score of a trial; `line`: the trial in one line. `rate`: shares with their uncertainty.
//! - `target`: a target of the project; `tally`: all trials against the targets.

pub mod case;
pub mod design;
pub mod draw;
pub mod geometry;
pub mod held_out;
pub mod kind;
pub mod laws;
pub mod line;
pub mod local_search;
pub mod noise;
pub mod noise_free;
pub mod posterior;
pub mod rate;
pub mod record;
pub mod score;
pub mod session;
pub mod statement;
pub mod tally;
pub mod target;
pub mod trial;
pub mod truth;
pub mod wheel_size;
