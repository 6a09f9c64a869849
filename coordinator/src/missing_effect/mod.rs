//! The search for a missing effect, as the farm runs it: candidates as jobs take them, and what is said in the end.
//!
//! # Layout
//! - [`candidate`]: explanations as additions to a job, and those of the library.
//! - [`range`]: along which variables an experiment can show a dependence, and how far.
//! - [`scan`]: laws outside the library, as curves along one variable; [`form`]: simple forms of them.
//! - [`curve`]: what such a law does along its variable, and its file for the user.
//! - `models`: every model that a search asks, made when it is asked; `design`: levels that were run, and runs that could be.
//! - `investigation`: a search in progress, as leases take it. `told`: its answer in names and sentences; `other_tests`: what no
//!   rolling wheel can decide.

pub mod candidate;
pub mod curve;
mod design;
pub mod form;
mod investigation;
mod models;
pub mod range;
mod rig_test;
pub mod scan;
mod told;

pub use investigation::{Investigation, InvestigationError};
pub use models::Models;
