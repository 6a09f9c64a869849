//! The growth of a study: by extensions, by further runs, and by its searches.
//!
//! # Layout
//! - `next_step`: the next step of a study. Pure.

mod next_step;

pub use next_step::{StudyMember, StudyRole, StudyStep, most_probable, next_step};
