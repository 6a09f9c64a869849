//! A map bound to a table.
//!
//! # Layout
//! - `source`: what is read from a row, and what a column of runs.csv is made of.
//! - `maker`: entries of a map to these, with every mistake.
//! - `bound`: a [`Binding`], which reads rows.

mod bound;
mod maker;
mod source;

pub(crate) use bound::{Above, Binding, of_cell};
pub(crate) use source::{Output, is_text};
