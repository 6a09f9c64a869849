//! How a study grows: by extensions, by further runs, and by what its searches find.
//!
//! # Layout
//! - `next_step`: what follows from where a study stands. Pure.

mod next_step;

pub use next_step::{Member, Part, Step, next_step};
