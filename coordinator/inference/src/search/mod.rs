//! Search the most probable parameters by generations, asked and told from outside.
//!
//! [`Search`] never runs the model. A round is a generation: its [`Proposal`](crate::Proposal)s can be evaluated at the
//! same time and are told their log-likelihoods in any order; impossible ones rank last. What the next generation is,
//! [`ga`](crate::ga) or [`cma_es`](crate::cma_es) decides.
//!
//! Neither knows the curvature at the optimum, so the [`Estimate`](crate::point::Estimate) has no standard deviations. It
//! has the history of the search instead.
//!
//! # Layout
//! - `settings`: those of either strategy, and their errors. `strategy`: either of them.
//! - `search`: the rounds. `view`: what the outside sees of them.

#[expect(clippy::module_inception, reason = "the noun of the module is the search")]
mod search;
mod settings;
mod strategy;
mod view;

pub use search::Search;
pub(crate) use settings::check_population;
pub use settings::{Settings, SettingsError};
pub(crate) use strategy::Next;
pub use view::Current;
