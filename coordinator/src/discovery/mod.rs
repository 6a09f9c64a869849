//! The search for a missing effect, as the farm runs it: candidates as jobs take them, and what is said in the end.
//!
//! # Layout
//! - `record`: what a search found, as it is stored and shown.
//! - [`candidate`]: explanations as additions to a job, and those of the library.
//! - [`range`]: along which variables an experiment can show a dependence, and how far.
//! - [`scan`]: laws outside the library, as curves along one variable; [`form`]: simple forms of them.
//! - [`curve`]: what such a law does along its variable, and its file for the user.

pub mod candidate;
pub mod curve;
#[cfg(test)]
pub(crate) mod fixture;
pub mod form;
pub mod range;
mod record;
pub mod scan;

pub use record::{
    ChiSquare, Discovery, Extension, JudgedEffect, NEXT_RUNS, NONE, NOT_IN_LIBRARY, NextRun, Outside, Verdict,
};
