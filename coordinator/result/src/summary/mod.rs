//! `summary.json`.
//!
//! # Layout
//! - `study`: the whole file.
//! - `calibration`: a line of the error ledger; `parameter`: its parameters. `point_estimate`: a fit or a search.
//! - `error`: errors that both have; `coverage`: of intervals.

pub(crate) mod calibration;
mod coverage;
pub(crate) mod error;
pub(crate) mod parameter;
pub(crate) mod point_estimate;
pub(crate) mod study;
