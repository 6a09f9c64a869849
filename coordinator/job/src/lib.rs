//! Turns the text of a job and its experiment into everything a calibration needs.

mod bevameter;
mod discovery_job;
mod discovery_settings;
mod errors;
mod extended_job;
mod job_file;
mod method;
mod noise;
mod point_job;
mod posterior;
mod predicted;
mod priors;
mod sampler_keys;
mod spec;

pub use bevameter::{BevameterReadings, PLATE, RING, Reading};
pub use discovery_job::{
    DISCOVERY, continued_job, discovery_job, effect_name, is_discovery, without_effects,
};
pub use discovery_settings::{Apply, DiscoverySettings};
pub use errors::LikelihoodSettings;
pub use extended_job::extended_job;
pub use job_file::Job;
pub use method::{AlgorithmName, AlgorithmSettings, AlgorithmSettingsError};
pub use noise::repeat_scatter;
pub use point_job::point_job;
pub use posterior::{ImpliedModuli, JointPrior, PosteriorPrior};
pub use priors::{FreeParameter, check_own, free_parameters};
pub use spec::{EffectsChanged, PREDICTION_DRAWS, Spec};
