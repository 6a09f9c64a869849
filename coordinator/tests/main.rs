//! The coordinator's parts together, without HTTP and store.

mod fuzz;
mod hidden_effect;
mod leasing;
mod sbc;
mod simulation;
