//! The most probable parameters by generations (genetic algorithm, CMA-ES), by ask and tell.
//!
//! [`Evolution`] never runs the model. A round is a generation: its [`Proposal`](crate::Proposal)s can be evaluated at the same
//! time and are told their log-likelihoods in any order; rejected ones rank last. [`ga`] or [`cma_es`] makes the next generation.
//!
//! Neither knows the curvature at the optimum, so the [`ModeEstimate`](crate::point_estimate::ModeEstimate) has no standard
//! deviations. It has the history of the generations instead.
//!
//! # Layout
//! - `generations`: the rounds.
//! - `settings`, `settings_error`: the settings of either strategy. `strategy`: either of them, with its state.
//! - `next_generation`: a strategy's request. `individual`: an evaluated point. `prior_space`: all axes of the prior.

pub mod cma_es;
pub mod ga;
mod generations;
mod individual;
mod next_generation;
mod prior_space;
mod settings;
mod settings_error;
mod strategy;

pub use cma_es::CmaEsSettings;
pub use ga::GaSettings;
pub use generations::Evolution;
pub use settings::EvolutionSettings;
pub use settings_error::{EvolutionSettingsError, MAX_POPULATION};
