//! Flags: warnings with a sentence for a test engineer.
//!
//! # Layout
//! - `kind`: a flag.
//! - `finding`: flags of the diagnostics' tests; `cause`: what a trend may come from.
//! - `calibration`: all flags of a calibration. `plates`: where a wheel contradicts them. `worker`: of what workers did wrong.
//! - `study`: all flags of a study. `interpolation`: where no physics predicts better.
//! - `model_limit`, `unsettled_run`: notes that raise no flag.

pub(crate) mod calibration;
pub(crate) mod cause;
pub(crate) mod finding;
pub(crate) mod interpolation;
pub(crate) mod kind;
pub(crate) mod model_limit;
mod plates;
pub(crate) mod study;
pub(crate) mod unsettled_run;
mod worker;
