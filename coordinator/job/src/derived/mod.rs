//! The jobs that follow from a job: point estimates beside it, extensions of it, effects of
//! a service's catalogue as its files, answers to questions, predictions of levels that are left out; and the experiment in which typical values stand for what it leaves unsaid.

pub(crate) mod accepting_job;
pub(crate) mod assumed_experiment;
pub(crate) mod discovery_job;
pub(crate) mod earlier_search;
pub(crate) mod extended_job;
pub(crate) mod one_model;
pub(crate) mod own_effects;
pub(crate) mod point_job;
pub(crate) mod validation_job;
