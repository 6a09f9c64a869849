//! Turns the text of a job and its experiment into everything a calibration needs.
//!
//! # Layout
//! - `job_file`: [`JobFile`], a job as written.
//! - `table`: the tables of a job, as written and what they mean.
//! - `data`: the fitted measurements: noise, likelihood, predicted values; whether their order follows a condition.
//! - `spec`: [`Spec`], a calibration as its files determine it; `spec_words` says it in words.
//! - `plain_parameter`: [`PlainParameter`], what a search may free. `model_switch`: [`ModelSwitch`], what it may turn.
//!   `effect_on_nodes`: [`EffectOnNodes`], an effect together with such a turn.
//! - `plausibility`: questions about what is possible, but was probably not meant.
//! - `derived`: the jobs, and the experiment, that follow from a job and its experiment.

mod data;
mod derived;
mod effect_on_nodes;
mod job_file;
mod model_switch;
mod plain_parameter;
mod plausibility;
mod spec;
mod spec_words;
mod table;

pub use data::bevameter_readings::{BevameterReadings, PLATE, RING, Reading};
pub use data::confounded_order::{ConfoundedOrder, SetCondition, confounded_orders};
pub use data::level::levels_of;
pub use data::noise::{conditions, repeat_scatter, repeats};
pub use data::soil_scatter::SoilScatter;
pub use derived::accepting_job::accepting_job;
pub use derived::assumed_experiment::{AssumedExperiment, SiteProperty, UnsaidProperty};
pub use derived::discovery_job::{continued_job, effect_name, model_kind, searched_job, without_effects};
pub use derived::earlier_search::{earlier_search, is_earlier_search, searched_model};
pub use derived::extended_job::{extended_job, with_free, with_setting};
pub use derived::one_model::model_job;
pub use derived::own_effects::{OwnEffect, foreign_effects, with_own_effects, without_own_effects};
pub use derived::point_job::point_job;
pub use derived::validation_job::validation_job;
pub use effect_on_nodes::EffectOnNodes;
pub use job_file::{JobFile, JobModels};
pub use model_switch::{MODEL_SWITCHES, ModelSwitch};
pub use plain_parameter::{PLAIN_PARAMETERS, PlainParameter};
pub use plausibility::{Question, Unanswered, check_accepted, questions};
pub use spec::{EffectsChanged, PREDICTION_DRAWS, Spec};
pub use table::algorithm_settings::{AlgorithmName, AlgorithmSettings, AlgorithmSettingsError};
pub use table::candidate_priors::candidate_priors;
pub use table::discovery_settings::{Apply, DiscoverySettings};
pub use table::likelihood_settings::LikelihoodSettings;
pub use table::posterior_prior::{ImpliedModuli, JointPrior, PosteriorPrior};
pub use table::prior_entry::{FreeParameter, PriorEntry, check_own, free_parameters};
pub use table::prior_entry_error::PriorEntryError;
