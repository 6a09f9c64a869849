//! Priors, likelihood and random streams.
//!
//! ```
//! use statistics::rng::Stream;
//! use statistics::{Datum, Distribution, ErrorSd, Likelihood, Marginal, Prior};
//!
//! let uniform = Distribution::Uniform { lower: 0.0, upper: 2.0 };
//! let prior = Prior::new(vec![Marginal::new(uniform, None)?]);
//! let theta = prior.sample(&mut Stream::new(1, 0, 0, 0));
//! assert!((prior.log_density(&theta) - 0.5_f64.ln()).abs() < 1e-12);
//!
//! // The prediction is one standard deviation off: -ln(sqrt(2 pi) 0.5) - 1/2.
//! let datum = Datum { run: 0, channel: 0, value: 1.5, sd: ErrorSd::Known(0.5) };
//! let log_likelihood = Likelihood::new(vec![datum])?.log_likelihood(&[1.0], &theta)?;
//! assert!((log_likelihood.value() + 0.7258).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The crate is pure: no clock, no network, no store. Every transcendental function comes from `libm` and every sum
//! has a fixed order, so the same input gives the same bits on every machine.
//!
//! # Layout
//! - [`log_likelihood`]: a log-likelihood that is finite or impossible, never NaN.
//! - [`likelihood`]: the density of the measurements, given predictions.
//! - [`prior`]: truncated distributions, and the coordinates in which a sampler moves.
//! - [`rng`]: one random stream per (seed, stage, particle, step).

pub mod likelihood;
pub mod log_likelihood;
pub mod prior;
pub mod rng;

pub use likelihood::{
    CommonError, CommonErrorSize, Datum, Discrepancy, ErrorLaw, ErrorSd, Innovation, Likelihood,
    LikelihoodError, Sensitive,
};
pub use log_likelihood::{LogLikelihood, NotANumber};
pub use prior::{Distribution, Marginal, Prior, PriorError};
