//! Tables that compare models with measurements: rows, errors, intervals, the error ledger.
//!
//! # Layout
//! - `row`: a measured channel of a run with its predictions. `comparison`: all rows with their errors; `compared` computes it.
//! - `ledger`: errors of the calibrations of a study; `fixed_sigma`: the noise standard deviations in which they compare.
//! - `errors`: root mean square errors by channel. `group`: errors by level of a condition; `level`: these levels.
//! - `predictive`: the posterior predictive distribution; `mixture`: its quantiles. `interpolation`: interpolation without physics.
//! - `correction`: predictions corrected by the model's errors in other conditions (`corrected`); `conditions`: coordinates of the rig.
//! - `combination`: the average over the models of a study (`combined_row`) and the measurements alone (`without_model`).
//! - `prediction`: all predictions, run by run.
//! - `holdout_group`: places of holdout runs among the fitted conditions; `holdout_errors`: errors there.
//! - `coverage`: measurements inside their intervals. `readings`: errors of plates and rings. `transient_errors`: errors of the sinkage
//!   before the steady state.
//! - `refusal`: draws at which the model refuses a run. `error_model`: the error model in words. `posterior`: draws as a table.

mod combination;
pub mod combined_row;
mod compared;
pub mod comparison;
mod conditions;
pub mod corrected;
pub mod correction;
pub mod coverage;
pub mod error_model;
pub mod errors;
pub mod fixed_sigma;
pub mod group;
pub mod holdout_errors;
pub mod holdout_group;
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
pub mod transient_errors;
mod without_model;
