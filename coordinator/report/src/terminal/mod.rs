//! Text for a terminal.
//!
//! # Layout
//! - `specification`: a job before it runs. `campaign`: the source of its measurements. `status`: the state of a calibration.
//! - `list`: all calibrations, with what their studies found.
//! - `brief`: a study in a few lines; `story`: what is wrong, what is missing, what next; `ending`: where the files are; `run_end`: all
//!   three in at most 15 lines.
//! - `study`: the complete text of a study; `models`: its compared models; `ledger`: the errors of its calibrations.
//! - `calibration`: one calibration; `comparison`: its rows and errors; `diagnostics`: its diagnostics.
//! - `followed`: a campaign that is followed.
//! - `recording`: a recording that is followed.
//! - `prediction`: conditions of one's own; `decision`: options by their expected losses.
//! - `rig`: offsets of sessions, tarings and operators.
//! - [`discovery`]: a search for a missing effect. `validation`: the levels of a factor, each left out in turn.
//! - `table`: tables of columns; `column`: widths, cells that may be empty, sentences with a label.

mod brief;
mod calibration;
mod campaign;
mod column;
mod comparison;
mod decision;
mod diagnostics;
pub mod discovery;
mod ending;
mod followed;
mod ledger;
mod list;
mod models;
mod prediction;
mod recording;
mod rig;
mod run_end;
mod specification;
mod status;
mod story;
mod study;
mod table;
mod validation;

pub use brief::brief;
pub use column::{WIDTH, labelled_to};
pub use comparison::{comparison, groups};
pub use decision::decision;
pub use diagnostics::diagnostics;
pub use ending::ending;
pub use followed::followed;
pub use list::list;
pub use prediction::{prediction, prediction_csv};
pub use recording::{RECORDING_TITLES, recorded_rows, recorded_time, recording_end};
pub use rig::rig;
pub use run_end::run_end;
pub use specification::specification;
pub use status::status_table;
pub use story::story;
pub use study::study;
pub use validation::validation;
