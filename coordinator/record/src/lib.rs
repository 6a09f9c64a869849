//! What a calibration leaves behind, as the store keeps it: the types between calibration, store and results.
//!
//! # Layout
//! - [`fact`]: what must survive a restart, in the order in which it came about.
//! - `evaluation_key`: the number that names an evaluation for ever.
//! - `calibration`, `sample`, `estimate`: stored rows.
//! - `replay`: what a restart reads back.
//! - `discovery`: the record of a search for a missing effect.

mod calibration;
mod discovery;
mod estimate;
mod evaluation_key;
pub mod fact;
mod replay;
mod sample;

pub use calibration::{CalibrationRow, ExperimentRow};
pub use discovery::{
    ChiSquare, Discovery, Extension, JudgedEffect, NEXT_RUNS, NONE, NOT_IN_LIBRARY, NextRun, Outside,
    Verdict, effect_of,
};
pub use estimate::EstimateRow;
pub use evaluation_key::{EvaluationKey, HISTORIES, PREDICTIONS_FROM};
pub use fact::{EvaluationRow, Fact, Fingerprint, Kept};
pub use replay::{Stored, StoredEvaluation};
pub use sample::{Prediction, PriorDraw, Sample, StageRow, Subchains};
