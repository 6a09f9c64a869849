//! How well the missing effect is found, on experiments whose truth is known.
//!
//! # Layout
//! - [`study`]: one trial: an experiment with a hidden effect, drawn, searched and scored.
//! - [`ambiguous`]: how many further runs tell what the effect is. [`rig`]: rigs with a flaw, where no effect is missing.
//! - [`mod@reference`], [`changes`]: a reference campaign on the same soil, whose posterior is the prior. [`steady`]: one experiment after the other.
//! - [`tmcmc`]: the evidences of the search beside those of the sampler. [`data`]: the experiments of `tests/data`.

pub mod ambiguous;
pub mod changes;
pub mod data;
pub mod reference;
pub mod rig;
pub mod steady;
pub mod study;
pub mod tmcmc;
