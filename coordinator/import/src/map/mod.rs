//! The map of an import: the origin of each column of runs.csv.
//!
//! # Layout
//! - `content`: the content of a map.
//! - `entry`: keys of a table of the map, read with all their mistakes.
//! - `read`: parses the text of a map.

mod content;
mod entry;
mod read;

pub(crate) use content::{Entry, Map, Origin, QUESTION, Recording, quantity_of};
pub(crate) use read::read;
