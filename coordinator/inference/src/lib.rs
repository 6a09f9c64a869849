//! Update a prior by measurements: everything statistical of the farm, and nothing else.
//!
//! The crate is pure: no clock, no network, no store. A result is a function of the prior, the settings, the
//! seed and the log-likelihoods alone. Every transcendental function comes from `libm` and every sum has a
//! fixed order, so the same input gives the same bits on every machine.
//!
//! # Layout
//! - [`round`]: proposals that can be evaluated at the same time; what every ask/tell algorithm shares.
//! - [`tmcmc`]: the ask/tell sampler, its stages and its evidence.
//! - [`point`]: what every search for the most probable parameters shares: axes, the result.
//! - [`lm`]: the ask/tell fit of the most probable parameters.
//! - [`search`]: the ask/tell search by generations; [`ga`], [`cma_es`]: how the next generation is made.
//! - [`diagnostics`]: summaries of draws: moments, quantiles, densities, bounds, effective sizes.

pub mod diagnostics;
pub mod evolution;
pub mod lm;
mod phase;
pub mod point_estimate;
mod round;
mod tell;
pub mod tmcmc;

pub use phase::EvaluationCount;
pub use round::{Proposal, ProposalRound};
pub use tell::{InferenceFailure, TellError, TellProgress};
pub use tmcmc::{
    Algorithm, EvaluationResult, Particle, PosteriorSample, Sampler, StageProgress, StageRecord,
    TmcmcSettings, TmcmcSettingsError,
};
