//! The record of a worker process: what it told the farm, and what the farm counted.

use std::collections::BTreeMap;

use serde::Serialize;
use utoipa::ToSchema;

use crate::calibration::Calibration;

/// The state of a worker process, as the farm knows it from the worker's messages.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct WorkerRecord {
    /// Version of the equations that the worker computes.
    pub model_version: String,
    /// The models that are not ours that it runs: the version of each by its name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub models: BTreeMap<String, String>,
    /// The job of a queue that started the worker, as in `slurm 1234_5`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub queue_job: Option<String>,
    /// Number of threads that simulate.
    pub threads: u32,
    /// Mean time of the worker's evaluations so far `[s]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evaluation_s: Option<f64>,
    /// Number of leases that the worker holds.
    pub holds: u64,
    /// Number of results that were accepted.
    pub completed: u64,
    /// Number of faults that the worker reported or was blamed for.
    pub faults: u64,
    /// Reason of the worker's quarantine, if it computes wrongly.
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
    /// Returns the version of the equations with which the worker computes a calibration: of the built-in equations, or of the
    /// calibration's external model; `None` if the worker does not run this model.
    pub(super) fn equations_for(&self, calibration: &Calibration) -> Option<&str> {
        let external = calibration.spec.model.external.as_ref();
        self.equations_of_model(external.map(|model| model.source.name()).as_deref())
    }

    /// Returns the worker's version of the external model with a name, or without a name, its version of the built-in equations.
    pub(super) fn equations_of_model(&self, external: Option<&str>) -> Option<&str> {
        match external {
            None => Some(self.model_version.as_str()),
            Some(name) => self.models.get(name).map(String::as_str),
        }
    }
}
