//! A small part of each study.

mod challenge;
mod decision;
mod fuzz;
mod hidden_effect;
mod sbc;
mod stream;
