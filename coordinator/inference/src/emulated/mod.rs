//! Emulated stages: TMCMC on an emulator of the model's outputs, corrected by evaluations of the model.
//!
//! An emulator is fitted to the outputs of few evaluations and refitted in the frame of the present stage. The tempered posterior
//! that it predicts is sampled without the model, and a batch of these draws is evaluated: where the emulated log-likelihoods agree,
//! the exponent grows; else the batch refines the emulator. At exponent 1 the final draws are evaluated and weighted by
//! `likelihood / emulated likelihood`, so posterior and evidence are importance estimates of the model itself.
//!
//! A final sample whose weights are uneven refines the emulator too; a problem that the emulator does not learn is sampled by draws
//! and moves of the model, and the result says so.
//!
//! # Layout
//! - `sampler`: [`EmulatedSampler`]. `round`: its rounds. `design`: the first. `refinement`: the stages. `final_draws`: the weighted
//!   draws. `fallback`: the sampler of the model itself. `learning`: the fit of the emulators.
//! - `batch`: the evaluations of a round. `judgement`: whether the emulator agrees with them. `scatter`: rough models.
//! - `emulator`: the emulator. `target`: the tempered posterior that it predicts. `sample`: draws of that.
//! - `record`: [`EmulatorRecord`], what each round found.
//!
//! # Source
//! Dinkel et al. 2023, Comput. Methods Appl. Mech. Eng. 405:115868 (adaptive emulation in TMCMC); Hesterberg 1995, Technometrics
//! 37:185, doi:10.1080/00401706.1995.10484303 (defensive mixtures).

mod batch;
mod design;
mod emulator;
mod fallback;
mod final_draws;
mod judgement;
mod learning;
mod record;
mod refinement;
mod round;
mod sample;
mod sampler;
mod scatter;
mod target;

pub use emulator::{EmulatorCoordinates, KrigingSettings, TrendDegree};
pub use record::{EmulatorRecord, EmulatorRound, FinalWeights};
pub use sampler::EmulatedSampler;
