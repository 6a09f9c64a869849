//! Damaged inputs of every reader, each of which is a function of a seed and its number.
//!
//! # Layout
//! - `corpus`: the undamaged inputs: jobs of `examples/` and `tests/data/`, the catalogue, a wheel as a mesh, messages of workers.
//! - `damage`: random damages of texts and bytes.
//! - `input`: a damaged input and its reader.
//! - `verdict`: the promises of a reader: no panic, one line that names the file, a bound on time.
//! - `tally`: counts over many inputs.

pub mod corpus;
pub mod damage;
pub mod input;
pub mod tally;
pub mod verdict;
