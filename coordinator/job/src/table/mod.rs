//! The tables of `job.toml`: their keys, and the settings that they state.

pub(crate) mod algorithm_settings;
pub(crate) mod candidate_priors;
pub(crate) mod discovery_settings;
mod error;
pub(crate) mod likelihood_settings;
pub(crate) mod model_entry;
pub(crate) mod posterior_prior;
pub(crate) mod prior_entry;
pub(crate) mod prior_entry_error;
pub(crate) mod sampler;
