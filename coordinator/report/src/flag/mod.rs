//! Flags: warnings about a result, each with a sentence for a test engineer.
//!
//! # Layout
//! - `calibration`: all flags of a calibration. `study`: all flags of a study.
//! - `finding`: flags of the tests in the diagnostics; `cause`: possible causes of trends. `plates`: conflicts of wheel and plate tests.
//! - `worker`: wrong or failed workers. `interpolation`: channels that interpolation predicts better than the model.
//! - `model_limit`, `unsettled_run`: notes that are not flags.

pub mod calibration;
pub mod cause;
pub mod finding;
pub mod interpolation;
pub mod model_limit;
mod plates;
pub mod study;
pub mod unsettled_run;
mod worker;
