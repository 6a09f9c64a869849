//! The map of an import: the origin of each column of runs.csv.
//!
//! # Layout
//! - `content`: the content of a map.
//! - `entry`: keys of a table of the map, read with all their mistakes.
//! - `recording`: the table `[recording]`; `join`: the tables `[join]`.
//! - `read`: parses the text of a map.

mod content;
mod entry;
mod join;
mod read;
mod recording;

pub(crate) use content::{Entry, Join, Layout, Map, Mark, Origin, QUESTION, Recording, Zero, quantity_of};
pub(crate) use read::read;
