//! From the text of a formula to operations.
//!
//! # Layout
//! - `token`, `parse`: the text to a graph of operations.
//! - `graph`: the operations of one effect, without repetition.
//! - `dimension`: check of units; `proportion`: whether a formula only scales the quantity that it replaces.

pub(crate) mod dimension;
pub(crate) mod graph;
pub(crate) mod parse;
pub(crate) mod proportion;
pub(crate) mod token;
