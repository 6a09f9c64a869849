//! What is known of a worker process.

use std::collections::BTreeMap;

use serde::Serialize;
use utoipa::ToSchema;

use crate::calibration::Calibration;

/// What is known of a worker process.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct WorkerRecord {
    /// Version of the equations that it computes.
    pub model_version: String,
    /// The models that are not ours that it runs: the version of each by its name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub models: BTreeMap<String, String>,
    /// The job of a queue that started it, as in `slurm 1234_5`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub queue_job: Option<String>,
    /// Threads that simulate.
    pub threads: u32,
    /// Mean time of its evaluations so far `[s]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evaluation_s: Option<f64>,
    /// Leases that it holds.
    pub holds: u64,
    /// Results that counted.
    pub completed: u64,
    /// Faults that it reported or was blamed for.
    pub faults: u64,
    /// Why it is quarantined, if it is: it computes wrongly.
    pub quarantined: Option<String>,
    /// Milliseconds since its last message, when asked.
    pub silent_ms: u64,
    #[serde(skip)]
    pub(super) last_seen_ms: u64,
    /// The highest number of a lease given to it and not known to be lost.
    #[serde(skip)]
    pub(super) given: u64,
}

impl WorkerRecord {
    /// Returns the version of the equations that it computes for a calibration: its own, or that of the model that is not ours; `None`
    /// where it does not run that.
    pub(super) fn equations_for(&self, calibration: &Calibration) -> Option<&str> {
        let external = calibration.spec.model.external.as_ref();
        self.equations_of_model(external.map(|model| model.source.name()).as_deref())
    }

    /// Returns the version that it computes of a model that is not ours, by the name of the model; without a name, of our equations.
    pub(super) fn equations_of_model(&self, external: Option<&str>) -> Option<&str> {
        match external {
            None => Some(self.model_version.as_str()),
            Some(name) => self.models.get(name).map(String::as_str),
        }
    }
}
