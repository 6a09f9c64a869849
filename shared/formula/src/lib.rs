//! Effects as formulas: their grammar, their files, and how they are evaluated a block of points at a time.
//!
//! # Layout
//! What stands in a file:
//! - [`effect`]: an effect file, read and checked.
//! - [`catalogue`]: the effect files that come with the program.
//! - [`variable`], [`hook`]: what a formula sees, and which quantity of the model it replaces.
//! - [`unit`]: units, and the dimensions behind them.
//!
//! From text to numbers:
//! - `token`, `parse`: text to a graph of operations.
//! - `graph`: the operations of one effect, each of them once.
//! - `dimension`: whether the units of a formula can be right; `proportion`: whether it only scales what it replaces.
//! - [`program`]: a formula made ready; [`block`]: its evaluation at many points.
//! - [`word`]: what was probably meant.
//! - [`elementary`]: `exp`, `ln` and powers that vectorise and give the same bits on every machine.
//!
//! Everything is pure, and safe to feed with a stranger's text: no loops, no names but the declared ones, limits on every
//! size. The crate knows neither the wheel-soil models nor probability: a prior is kept as it was written.

pub mod block;
pub mod catalogue;
mod dimension;
pub mod effect;
pub mod elementary;
mod graph;
pub mod hook;
mod parse;
pub mod program;
mod proportion;
mod token;
pub mod unit;
pub mod variable;
pub mod word;

pub use effect::{Effect, EffectError, Parameter};
pub use hook::Hook;
pub use program::Program;
pub use variable::Variable;
