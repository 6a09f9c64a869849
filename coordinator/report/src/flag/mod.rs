//! Flags: warnings with a sentence for a test engineer.
//!
//! # Layout
//! - `finding`: flags of the diagnostics' tests; `cause`: what a trend may come from.
//! - `calibration`: all flags of a calibration. `plates`: where a wheel contradicts them. `worker`: of what workers did wrong.
//! - `study`: all flags of a study. `interpolation`: where no physics predicts better.
//! - `model_limit`, `unsettled_run`: notes that raise no flag.

pub mod calibration;
pub mod cause;
pub mod finding;
pub mod interpolation;
pub mod model_limit;
mod plates;
pub mod study;
pub mod unsettled_run;
mod worker;
