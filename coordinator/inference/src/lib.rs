//! Bayesian updating by ask and tell: samplers, point estimates and diagnostics.
//!
//! No algorithm runs the model. Each lists the parameter vectors of a round, which can be evaluated at the same time and
//! anywhere, and is told their results in any order; the last result of a round leads to the next.
//!
//! ```
//! use inference::{Sampler, TmcmcSettings};
//! use statistics::{Datum, Distribution, ErrorSd, Likelihood, Marginal, Prior};
//!
//! // One measurement of x, 1.0 +- 0.5, under the prior N(0, 1).
//! let prior = Prior::new(vec![Marginal::new(Distribution::Normal { mean: 0.0, sd: 1.0 }, None)?]);
//! let datum = Datum { run: 0, channel: 0, value: 1.0, sd: ErrorSd::Known(0.5) };
//! let likelihood = Likelihood::new(vec![datum])?;
//! let settings = TmcmcSettings { particles: 500, ..TmcmcSettings::default() };
//!
//! let mut sampler = Sampler::new(prior, settings)?;
//! let posterior = loop {
//!     for proposal in sampler.round().pending().to_vec() {
//!         let predicted = [proposal.theta[0]]; // the model: x itself
//!         let log_likelihood = likelihood.log_likelihood(&predicted, &proposal.theta)?;
//!         sampler.tell(proposal.particle, log_likelihood)?;
//!     }
//!     if let Some(failure) = sampler.failure() {
//!         return Err(failure.into());
//!     }
//!     if let Some(posterior) = sampler.posterior() {
//!         break posterior;
//!     }
//! };
//!
//! // The evidence is N(1; 0, 1 + 0.25): -ln sqrt(2 pi 1.25) - 1 / 2.5 = -1.43.
//! assert!((posterior.log_evidence + 1.43).abs() < 4.0 * posterior.log_evidence_se + 0.01);
//! assert!(posterior.equilibrated);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The crate is pure: no clock, no network, no store. A result is a function of the prior, the settings, the
//! seed and the told results alone. Every transcendental function comes from `libm` and every sum has a
//! fixed order, so the same input gives the same bits on every machine.
//!
//! # Layout
//! - `round`: a round of proposals and its results. `tell`: the outcomes of telling. `phase`: the progress of an algorithm.
//! - [`tmcmc`]: the sampler, its stages and its evidence. `mixture`: the proposals of its independent draws.
//! - [`point_estimate`]: the axes and the result of every point estimate.
//! - [`lm`]: the Levenberg-Marquardt fit. [`evolution`]: the genetic algorithm and CMA-ES.
//! - [`gaussian_process`]: interpolation of measurements, without a model. [`discrepancy`]: the misfit of a model between them.
//! - [`emulated`]: the sampler of expensive models. [`numerical_noise`]: the scatter of a rough model.
//! - [`response_surface`]: polynomials of the model's outputs over a posterior.
//! - [`tracking`]: parameters that vary in time, through a recording. Its samples come one after another, so that it takes the model as a
//!   function.
//! - [`diagnostics`]: summaries and tests of draws and residuals.

pub mod diagnostics;
pub mod discrepancy;
pub mod emulated;
pub mod evolution;
pub mod gaussian_process;
pub mod lm;
mod mixture;
pub mod numerical_noise;
mod phase;
pub mod point_estimate;
pub mod response_surface;
mod round;
mod tell;
pub mod tmcmc;
pub mod tracking;

pub use emulated::{EmulatedSampler, EmulatorRecord, EmulatorRound, FinalWeights};
pub use phase::EvaluationCount;
pub use round::{Proposal, ProposalRound};
pub use tell::{InferenceFailure, TellError, TellProgress};
pub use tmcmc::{
    Algorithm, MAX_PARTICLES, Particle, PosteriorSample, PosteriorUpdate, Sampler, StageMethod,
    StageProgress, StageRecord, TmcmcSettings, TmcmcSettingsError, UpdateMethod, UpdateProgress,
    UpdatedPosterior,
};
