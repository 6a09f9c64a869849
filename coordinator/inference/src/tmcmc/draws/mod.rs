//! Stages of independent draws: importance sampling along the tempering exponents.
//!
//! A mixture of t-densities is fitted to the weighted draws of the last stage, and the next stage's draws come from it
//! independently: a whole stage is one round. A draw x of the proposal q has at the exponent b the weight `L(x)^b p(x) / q(x)`,
//! whose mean is Z(b). The estimates of a stage use its own draws alone, which are independent of the fit that proposed them, and
//! the standard error is that of a mean. A small bias remains where a proposal is kept or dropped by its own effective sample
//! size per draw (ESS/N).
//!
//! # Layout
//! - `sample`: draws with their weights. `schedule`: the next exponent. `frame`: fits, in the coordinates that suit them.
//!   `proposal`: the proposal density.
//! - `stage`: one stage in progress.
//!
//! # Source
//! Cappé, Guillin, Marin & Robert 2004, J. Comput. Graph. Stat. 13:907, doi:10.1198/106186004X12803 (adaptive importance
//! sampling); Hesterberg 1995, Technometrics 37:185, doi:10.1080/00401706.1995.10484303 (defensive mixtures).

mod frame;
mod proposal;
mod sample;
mod schedule;
mod stage;

pub(crate) use frame::Fit;
pub(crate) use proposal::{DrawKey, DrawProposal};
pub(crate) use sample::{ImportanceWeights, WeightedSample};
pub(super) use schedule::next_exponent;
pub(super) use stage::{Anchor, DrawStage, DrawStart, Forecast, Standing};
