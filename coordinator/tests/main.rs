//! The coordinator's parts together, without HTTP and store.

mod hidden_effect;
mod leasing;
mod sbc;
mod simulation;
