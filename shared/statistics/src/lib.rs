//! The statistics that coordinator and workers share.
//!
//! The crate is pure: no clock, no network, no store. Every transcendental function comes from `libm` and every sum
//! has a fixed order, so the same input gives the same bits on every machine.
//!
//! # Layout
//! - [`log_likelihood`]: a log-likelihood that is finite or impossible, never NaN.
//! - [`likelihood`]: the score of predictions against measurements.
//! - [`prior`]: truncated and renormalised distributions, and the coordinates in which a sampler moves.
//! - [`rng`]: one random stream per (seed, stage, particle, step).
//! - [`metamodel`]: the moves of a sampler, and how a cheap model takes them for an expensive one.

pub mod likelihood;
pub mod log_likelihood;
pub mod metamodel;
pub mod prior;
pub mod rng;

pub use likelihood::{
    CommonError, CommonErrorSize, Datum, Discrepancy, ErrorLaw, ErrorSd, Likelihood, LikelihoodError,
};
pub use log_likelihood::{LogLikelihood, NotANumber};
pub use metamodel::{Metamodel, ModelPair, Subchain, SubchainEnd};
pub use prior::{Distribution, Marginal, Prior, PriorError};
