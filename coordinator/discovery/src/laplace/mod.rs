//! Laplace's approximation: the fit of a model and the evidence read from it.
//!
//! # Layout
//! - `coordinate`: parameters as standard normal coordinates. `strength_prior`: the heavier tails of a candidate's strengths.
//! - `point`: an evaluated position. `quadratic`: the expansion of the log posterior about it. `noise`: its part along noise sds.
//! - `fit`: the posterior mode of one model; `correction`: its derivatives with a low-fidelity model. `batch`: several fits in
//!   parallel.
//! - `evidence`: the integral over a quadratic. `importance`: the same integral by importance sampling. `draws`: posterior draws.
//! - `conditional`: the evidence of a fitted model under another error model.
//! - `spread`: points one standard deviation from the mode. `reduced_discrepancy`: the likelihood of preliminary fits.

pub(crate) mod batch;
pub(crate) mod conditional;
pub(crate) mod coordinate;
pub(crate) mod correction;
pub(crate) mod draws;
pub(crate) mod evidence;
pub(crate) mod fit;
pub(crate) mod importance;
pub(crate) mod noise;
pub(crate) mod point;
pub(crate) mod quadratic;
pub(crate) mod reduced_discrepancy;
pub(crate) mod spread;
pub(crate) mod strength_prior;
pub(crate) mod student;
