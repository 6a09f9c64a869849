//! Text for a terminal.
//!
//! # Layout
//! - `specification`: a job before it runs. `status`: states of calibrations.
//! - `study`: the results of a study; `calibration`: of one calibration; `comparison`: its errors.
//! - `ledger`: the errors of a study's calibrations.
//! - `diagnostics`: how far a result can be trusted. [`discovery`]: a search for a missing effect.
//! - `column`: widths and cells of columns.

mod calibration;
mod column;
mod comparison;
mod diagnostics;
pub mod discovery;
mod ledger;
mod specification;
mod status;
mod study;

pub use comparison::{comparison, groups};
pub use diagnostics::diagnostics;
pub use specification::specification;
pub use status::status_table;
pub use study::study;
