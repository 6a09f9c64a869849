//! The search for a missing effect, as the farm runs it: candidates as jobs take them, and what is said in the end.
//!
//! # Layout
//! - `record`: what a search found, as it is stored and shown.

#[cfg(test)]
pub(crate) mod fixture;
mod record;

pub use record::{
    ChiSquare, Discovery, Extension, JudgedEffect, NEXT_RUNS, NONE, NOT_IN_LIBRARY, NextRun, Outside, Verdict,
};
