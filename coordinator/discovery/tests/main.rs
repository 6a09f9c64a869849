//! Searches on models whose answer is known.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic as tests do")]

mod description;
mod effect_search;
mod exchange;
mod formulas;
mod further_effects;
mod inferred_noise;
mod inferred_sd_reduction;
mod pairs;
mod replacement;
mod rough_model;
mod search;
mod setup;
mod shared_errors;
