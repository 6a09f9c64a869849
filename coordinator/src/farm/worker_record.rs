//! What is known of a worker process.

use serde::Serialize;
use utoipa::ToSchema;

/// What is known of a worker process.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct WorkerRecord {
    /// Version of the equations that it computes.
    pub model_version: String,
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
