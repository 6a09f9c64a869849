//! Studies that judge the program and are not shipped with it. Each is a bench; a small part of each is a test.
//!
//! # Layout
//! - [`damaged_input`]: every reader of files and messages, fed damaged inputs.
//! - [`hidden_effect`]: how often the missing effect is found.
//! - [`challenge`]: challenges that others stated, of systems without wheels.
//! - [`sbc`]: simulation-based calibration of the whole chain.
//! - [`posterior_use`]: predictions of unseen conditions, decisions over synthetic campaigns, and recordings.
//! - [`farm_load`]: jobs and messages for a farm whose model costs nothing.
//! - [`calibration`]: a calibration on one thread. [`parallel`]: work on all threads. [`process`]: processor time and memory.
//!   [`error`]: the error of a study.

#![expect(
    missing_docs,
    reason = "the items are used by the benches and tests of this crate alone"
)]

pub mod calibration;
pub mod challenge;
pub mod damaged_input;
pub mod error;
pub mod farm_load;
pub mod hidden_effect;
pub mod parallel;
pub mod posterior_use;
pub mod process;
pub mod sbc;
