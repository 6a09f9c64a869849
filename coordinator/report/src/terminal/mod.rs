//! Text for a terminal.
//!
//! # Layout
//! - `specification`: a job before it runs. `campaign`: where its measurements come from. `status`: states of calibrations.
//! - `brief`: a study in a few lines; `story`: its three answers; `ending`: where the rest is. `ledger`: the errors of its calibrations.
//! - `study`: everything of a study; `calibration`: of one calibration; `comparison`: its errors.
//! - `diagnostics`: how far a result can be trusted. [`discovery`]: a search for a missing effect.
//! - `validation`: the levels of a factor, each left out in turn.
//! - `table`: tables of columns; `column`: the width of names, cells that may be empty, sentences behind a label.

mod brief;
mod calibration;
mod campaign;
mod column;
mod comparison;
mod diagnostics;
pub mod discovery;
mod ending;
mod ledger;
mod models;
mod specification;
mod status;
mod story;
mod study;
mod table;
mod validation;

pub use brief::brief;
pub use comparison::{comparison, groups};
pub use diagnostics::diagnostics;
pub use ending::ending;
pub use specification::specification;
pub use status::status_table;
pub use story::story;
pub use study::study;
pub use validation::validation;
