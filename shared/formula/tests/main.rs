//! Formulas from their text to their numbers.
#![allow(clippy::unwrap_used, clippy::float_cmp)]

mod catalogue;
mod evaluation;
mod fuzzed;
mod generate;
mod messages;
