//! `summary.json`, the summary of a study for programs.
//!
//! # Layout
//! - `study`: the whole file. `calibration`: a line of the error ledger.

pub mod calibration;
pub mod study;
