//! A map bound to a table.
//!
//! # Layout
//! - `source`: the inputs of a row, and the sources of the columns of runs.csv.
//! - `maker`: the binding of a map's entries, with every mistake.
//! - `bound`: a [`Binding`], which reads rows.

mod bound;
mod maker;
mod source;

pub(crate) use bound::{Above, Binding, cell_complaint};
pub(crate) use source::{Output, is_text};
