//! Validation: each level of a factor, predicted by a calibration on the other levels.
//!
//! - `factor`: the condition whose levels are left out. `left_out_level`: its levels. `judgement`: errors and coverage of predictions.
//! - `table`: all levels, with their total.

mod factor;
mod judgement;
mod left_out_level;
mod table;

pub use factor::Factor;
pub use judgement::Judgement;
pub use left_out_level::LeftOutLevel;
pub use table::{ValidatedLevel, Validation};
