//! The map of an import: where each column of runs.csv comes from, as its file says.
//!
//! # Layout
//! - `content`: what a map states.
//! - `entry`: keys of a table of the map, read with all their mistakes.
//! - `read`: the text of a map to a [`Map`].

mod content;
mod entry;
mod read;

pub(crate) use content::{Entry, Map, Origin, QUESTION, Recording, quantity_of};
pub(crate) use read::read;
