//! Damaged inputs of every reader, each a function of a seed and its number alone.
//!
//! # Layout
//! - `corpus`: what is damaged: the jobs of `examples/` and `tests/data/`, the catalogue, a wheel as a mesh, messages of workers.
//! - `damage`: how a text or bytes are damaged.
//! - `input`: a damaged input and the reader that takes it.
//! - `verdict`: what a reader must keep: no panic, one line that names the file, a bound on time.
//! - `tally`: what came of many.

pub mod corpus;
pub mod damage;
pub mod input;
pub mod tally;
pub mod verdict;
