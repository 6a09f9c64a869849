//! `summary.json`, the summary of a study for programs.
//!
//! # Layout
//! - `study`: the whole file. `calibration`: a line of the error ledger. `response_surface`: its response surface.

pub mod calibration;
pub mod response_surface;
pub mod study;
