//! A small part of each study.

mod fuzz;
mod hidden_effect;
mod sbc;
