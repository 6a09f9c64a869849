//! Update a prior by measurements: everything statistical of the farm, and nothing else.
//!
//! The crate is pure: no clock, no network, no store. A result is a function of the prior, the settings, the
//! seed and the log-likelihoods alone. Every transcendental function comes from `libm` and every sum has a
//! fixed order, so the same input gives the same bits on every machine.
//!
//! # Layout
//! - [`log_likelihood`]: a log-likelihood that is finite or impossible, never NaN.
//! - [`likelihood`]: score predictions against measurements.
//! - [`prior`]: distributions, truncated and renormalised; the coordinates in which the sampler moves.
//! - [`rng`]: one random stream per (seed, stage, particle, step).
//! - [`tmcmc`]: the ask/tell sampler, its stages and its evidence.
//! - [`diagnostics`]: summaries of draws: moments, quantiles, bounds, effective sizes.

pub mod diagnostics;
pub mod likelihood;
pub mod log_likelihood;
pub mod prior;
pub mod rng;
pub mod tmcmc;

pub use likelihood::{Datum, GaussianLikelihood, LikelihoodError, Sd};
pub use log_likelihood::{LogLikelihood, NotANumber};
pub use prior::{Distribution, Marginal, Prior, PriorError};
pub use tmcmc::{
    Algorithm, Current, Failure, Particle, Posterior, Progress, Proposal, Sampler, Settings, SettingsError,
    StageRecord, TellError,
};
