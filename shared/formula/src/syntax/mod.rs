//! Parsing of the text of a formula into operations.
//!
//! # Layout
//! - `token`, `parse`: parse the text into a graph of operations.
//! - `graph`: the operations of one effect, without repetition.
//! - `dimension`: check of units; `proportion`: whether a formula only scales the quantity that it replaces.

pub(crate) mod dimension;
pub(crate) mod graph;
pub(crate) mod parse;
pub(crate) mod proportion;
pub(crate) mod token;
