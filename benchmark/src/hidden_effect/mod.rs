//! How well the missing effect is found, on experiments whose truth is known.
//!
//! # Layout
//! - [`study`]: one trial: an experiment with a hidden effect, drawn, searched and scored.
//! - [`ambiguous`]: the number of further runs that identify the effect. [`rig`]: rigs with a flaw, where no effect is missing.
//! - [`mod@reference`], [`changes`]: the posterior of a reference campaign on the same soil as the prior.
//! - [`probability`]: whether the probabilities that searches state are right as often as they say, over all kinds.
//! - [`steady`]: experiments one after another, as a study searches them. [`tmcmc`]: the evidences of the search beside the sampler's.

pub mod ambiguous;
pub mod changes;
pub mod probability;
pub mod reference;
pub mod rig;
pub mod steady;
pub mod study;
pub mod tmcmc;
