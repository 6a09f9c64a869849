//! Evaluation of a graph of operations.
//!
//! # Layout
//! - [`program`]: a compiled formula; [`block`]: its evaluation at many points.
//! - `address`: addresses in the memory of a block; `arithmetic`: one operation.
//! - [`elementary`]: `exp`, `ln` and powers that vectorise and give the same bits on every machine.

mod address;
pub(crate) mod arithmetic;
pub mod block;
pub mod elementary;
pub mod program;
