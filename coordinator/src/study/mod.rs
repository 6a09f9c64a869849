//! How a study grows: by extensions, by further runs, and by what its searches find.
//!
//! # Layout
//! - `next_step`: what follows from where a study stands. Pure.
//! - `load`: where a study stands, from what is stored.

mod load;
mod next_step;

pub use load::{next_step_from, next_step_of, record, search_of};
pub use next_step::{Member, Part, Step, next_step};
