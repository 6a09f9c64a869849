//! Model against measurement: tables of a calibration.
//!
//! # Layout
//! - `row`: a measured channel of a run beside its prediction. `comparison`: all rows with their errors; `compared`:
//!   that of a calibration.
//! - `ledger`: errors of the calibrations of a study; `fixed_sigma`: the noise that they are measured by.
//! - `errors`: root mean square errors by channel. `group`: by level of a condition; `level`: those levels.
//! - `interpolation`: interpolation without physics. `predictive`: the posterior predictive distribution; `mixture`: its
//!   quantiles. `correction`: predictions corrected by what the model misses (`corrected`); `combination`: those of
//!   all models together (`combined_row`); `prediction`: all of them, run by run. `conditions`: those of the rig as coordinates.
//! - `coverage`: measurements inside their intervals. `readings`: errors of plates and rings.
//! - `refusal`: draws at which the model refuses a run. `error_model`: the error model in words. `posterior`: the draws.

mod combination;
pub mod combined_row;
mod compared;
pub mod comparison;
mod conditions;
mod corrected;
mod correction;
pub mod coverage;
pub mod error_model;
pub mod errors;
pub mod fixed_sigma;
pub mod group;
pub mod interpolation;
pub mod ledger;
pub mod level;
pub mod mixture;
pub mod posterior;
pub mod prediction;
pub mod predictive;
pub mod readings;
pub mod refusal;
pub mod row;
