//! The growth of a study: by extensions, by further runs, and by its searches.
//!
//! # Layout
//! - `lineage`: how the calibrations of a study follow from one another. Pure.
//! - `next_step`: the next step of a study. Pure.

mod lineage;
mod next_step;

pub use lineage::Lineage;
pub use next_step::{StudyFindings, StudyStep, most_probable, next_step};
