//! Studies that judge the program and are not shipped with it. Each is a bench; a small part of each is a test.
//!
//! # Layout
//! - [`damaged_input`]: every reader of files and messages, fed damaged inputs.
//! - [`hidden_effect`]: how often the missing effect is found.
//! - [`sbc`]: simulation-based calibration of the whole chain.

#![expect(
    missing_docs,
    reason = "the items are used by the benches and tests of this crate alone"
)]

pub mod damaged_input;
pub mod hidden_effect;
pub mod sbc;
