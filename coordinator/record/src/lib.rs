//! Stored rows of a calibration: the types between calibration, store and results.
//!
//! # Layout
//! - [`fact`]: facts that must survive a restart, in order of occurrence.
//! - `evaluation_key`: the permanent number of an evaluation.
//! - `calibration`, `sample`, `estimate`: stored rows. `membership`: the place of a calibration in its study.
//! - `replay`: rows that a restart reads back.
//! - `verification`: how many answers of workers are verified.
//! - `token`: bearer tokens and their roles.
//! - `study_details`: what people say of a study.
//! - `discovery`: the record of a search for a missing effect. `outside`: a law outside the library.
//! - `law_formulas`: the formulas of such a law.

mod calibration;
mod discovery;
mod estimate;
mod evaluation_key;
pub mod fact;
mod law_formulas;
mod membership;
mod outside;
mod replay;
mod sample;
mod study_details;
mod token;
mod verification;

pub use calibration::{CalibrationRow, ExperimentRow, SealKey};
pub use discovery::{
    ChiSquare, CurveDatum, Discovery, EffectCurves, Extension, ImplausibleParameter, JudgedEffect,
    JudgedReplacement, JudgedRigError, JudgedSet, NEXT_RUNS, NONE, NOT_IN_LIBRARY, NextRun, NotTried,
    RemainingMisfit, RigOffset, RunInformation, Verdict, addition_name, effect_of, parts_of, parts_of_effect,
};
pub use estimate::EstimateRow;
pub use evaluation_key::{EvaluationKey, HOLDOUT_RUNS_FROM, LIKELIEST, PREDICTIONS_FROM};
pub use fact::{Dispute, EvaluationRow, Fact, Fingerprint, Kept};
pub use law_formulas::{FormulaClass, LawFormula, LawFormulas, SplittingCondition};
pub use membership::{Change, Membership, Role};
pub use outside::{FittedForm, LawPlace, Outside};
pub use replay::Stored;
pub use sample::{Prediction, PriorDraw, RejectionReason, StageRow};
pub use study_details::StudyDetails;
pub use token::{Token, TokenHash, TokenRole};
pub use verification::{Quarantine, Repeats, Verified};
