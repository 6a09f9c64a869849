//! Turns the text of a job and its experiment into everything a calibration needs.
//!
//! # Layout
//! - `job`: [`Job`], a job as users write it, as a value. `addition`: what changes it. `named_files`: the files that it names.
//! - `table`: the tables of a job, as written and what they mean. [`schema`]: their JSON schemas; `derived_schema`: schemas of types.
//! - `data`: the fitted measurements: noise, likelihood, predicted values; whether their order follows a condition.
//! - `decision`: [`Decision`], options and what they would cost; conditions that were not measured, and quantities of formulas.
//!   `decision_file`: the decision of a job, or of a file that has nothing else.
//! - `spec`: [`Spec`], a calibration as its files determine it.
//! - `plain_parameter`: [`PlainParameter`], what a search may free. `model_switch`: [`ModelSwitch`], what it may turn.
//!   `effect_on_nodes`: [`EffectOnNodes`], an effect together with such a turn.
//! - `plausibility`: questions about what is possible, but was probably not meant.
//! - `text`: the texts of jobs that follow from a job; no other file edits them. `facts`: single facts that texts state.
//!   `service_effect`: effects of a service's catalogue as files of a job. `assumed_experiment`: [`AssumedExperiment`].

mod addition;
mod assumed_experiment;
mod data;
mod decision;
mod decision_file;
mod derived_schema;
mod effect_on_nodes;
mod facts;
mod job;
mod model_switch;
mod named_files;
mod plain_parameter;
mod plausibility;
pub mod schema;
mod service_effect;
mod spec;
mod table;
mod text;

pub use addition::{Addition, ModelChange};
pub use assumed_experiment::{AssumedExperiment, SiteProperty, UnstatedProperty};
pub use data::bevameter_readings::{BevameterReadings, PLATE, RING, Reading};
pub use data::confounded_order::{ConfoundedOrder, SetCondition, conditions_in_row_order, confounded_orders};
pub use data::level::{levels_of, load_levels_of};
pub use data::noise::{conditions, repeat_scatter, repeats, repeats_but_for_load};
pub use data::rig_groups::repeats_earlier_column;
pub use data::shared_error::SharedError;
pub use data::transient_readings::{RunTransient, TRANSIENT, TransientReadings, is_of_run};
pub use decision::{
    ConditionDefaults, Constraint, Decision, DecisionOption, PlannedCondition, PlannedRun, QUANTITIES,
    Quantity, QuantityFormula, QuantityValues, Statement, position_of, predicted_quantities,
};
pub use decision_file::read_decision;
pub use effect_on_nodes::EffectOnNodes;
pub use facts::{effect_name, foreign_effects, is_earlier_search, model_kind};
pub use job::{Job, JobModels};
pub use model_switch::{MODEL_SWITCHES, ModelSwitch, SettingValue};
pub use named_files::{NamedFile, NamedFiles};
pub use plain_parameter::{PLAIN_PARAMETERS, PlainParameter};
pub use plausibility::{Question, Unanswered, check_accepted, questions};
pub use service_effect::{ServiceEffect, effect_with_origin};
pub use spec::{EffectsChanged, PREDICTION_DRAWS, Spec};
pub use table::algorithm_settings::{AlgorithmName, AlgorithmSettings, AlgorithmSettingsError};
pub use table::candidate_priors::candidate_priors;
pub use table::discovery_settings::{Apply, DiscoverySettings};
pub use table::likelihood_settings::LikelihoodSettings;
pub use table::posterior_prior::{ImpliedModuli, JointPrior, PosteriorPrior};
pub use table::prior_entry::{FreeParameter, PriorEntry, check_candidate, check_effect, free_parameters};
pub use table::prior_entry_error::PriorEntryError;
pub use text::{
    accepting_job, continued_job, earlier_search, extended_job, model_job, point_job, searched_job,
    searched_model, validation_job, with_candidates, with_service_effects, without_effects,
    without_metamodel, without_service_effects,
};
