//! Leaving one level of a factor out in turn: what a model predicts of each level from the others.
//!
//! - `factor`: what is left out. `left_out_level`: the levels of an experiment. `judgement`: errors and coverage of a prediction.
//! - `table`: all levels, with their total.

mod factor;
mod judgement;
mod left_out_level;
mod table;

pub use factor::Factor;
pub use judgement::Judgement;
pub use left_out_level::LeftOutLevel;
pub use table::{ValidatedLevel, Validation};
