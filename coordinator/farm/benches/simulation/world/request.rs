//! A minimal request of a worker.

use shared::exchange::{ExchangeRequest, PROTOCOL_VERSION};

/// Makes a request for nothing, from a worker that has received every lease.
pub(crate) fn bare(worker: String, version: &str) -> ExchangeRequest {
    ExchangeRequest {
        worker,
        protocol: PROTOCOL_VERSION,
        model_version: version.into(),
        models: Default::default(),
        queue_job: None,
        threads: 1,
        evaluation_s: None,
        results: Vec::new(),
        holding: Vec::new(),
        returned: Vec::new(),
        started: Vec::new(),
        received: u64::MAX,
        want: 0,
        wait_ms: 0,
    }
}
