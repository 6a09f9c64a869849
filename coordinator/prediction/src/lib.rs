//! Predictions of conditions that were not measured, and decisions that rest on them: pure functions of a posterior and of simulations that
//! the caller makes.
//!
//! # Layout
//! - [`plan`]: which runs are predicted. [`statement`]: which probabilities are asked for.
//! - [`ensemble`]: the models of a study with their weights, and what each is asked. [`error`]: why there is no prediction.
//! - [`quantity_value`]: what follows from the channels of a run. [`draw`]: values and errors at each draw.
//! - [`spread`]: means and intervals over weighted draws. [`beyond`]: what lies outside the fitted range.
//! - [`balance`]: the slip at which a wheel climbs a slope.
//! - [`drawn_model`](mod@drawn_model): the model with its draws, for programs that simulate it themselves.
//! - [`follow`]: what further runs change. [`surprise`]: runs that contradict what was expected of them.
//! - [`recording`]: the parameters of the soil through a recording, and its changes.
//! - [`prediction`]: predictions of a plan. [`grid`]: predictions over a grid of conditions. [`decision`]: expected losses of options, and
//!   what one more run is worth.

pub mod balance;
pub mod beyond;
pub mod decision;
pub mod draw;
pub mod drawn_model;
pub mod ensemble;
pub mod error;
pub mod follow;
pub mod grid;
pub mod plan;
pub mod prediction;
pub mod quantity_value;
pub mod recording;
pub mod spread;
pub mod statement;
pub mod surprise;

pub use decision::DecisionAnswer;
pub use drawn_model::drawn_model;
pub use ensemble::{Answers, Ensemble, ModelWeight, Question, RunAnswers, Simulated};
pub use error::PredictionError;
pub use grid::{PredictionGrid, prediction_grid};
pub use plan::{Sweep, planned_runs};
pub use prediction::Prediction;
pub use statement::read_statements;
