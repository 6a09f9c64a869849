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
//! - [`round`]: proposals that can be evaluated at the same time; what every ask/tell algorithm shares.
//! - [`tmcmc`]: the ask/tell sampler, its stages and its evidence.
//! - [`point`]: what every search for the most probable parameters shares: axes, the result.
//! - [`lm`]: the ask/tell fit of the most probable parameters.
//! - [`search`]: the ask/tell search by generations; [`ga`], [`cma_es`]: how the next generation is made.
//! - [`discovery`]: the ask/tell search for the effect that the model is missing.
//! - [`diagnostics`]: summaries of draws: moments, quantiles, densities, bounds, effective sizes.

pub mod cma_es;
pub mod diagnostics;
pub mod discovery;
pub mod ga;
pub mod likelihood;
pub mod lm;
pub mod log_likelihood;
pub mod point;
pub mod prior;
pub mod rng;
pub mod round;
pub mod search;
pub mod tmcmc;

pub use likelihood::{CommonError, Datum, Discrepancy, ErrorLaw, Likelihood, LikelihoodError, Sd, Size};
pub use log_likelihood::{LogLikelihood, NotANumber};
pub use prior::{Distribution, Marginal, Prior, PriorError};
pub use round::{Failure, Progress, Proposal, TellError};
pub use tmcmc::{
    Algorithm, Answer, Current, Metamodel, Pair, Particle, Posterior, Sampler, Settings, SettingsError,
    StageRecord, Subchain, SubchainEnd,
};
