//! The interface of a coordinator for the loop.

use std::future::Future;

use shared::exchange::{ExchangeRequest, ExchangeResponse, WorkResult};
use shared::model::ModelVariant;

/// Why an exchange failed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ExchangeError {
    /// The coordinator is away or busy: try again later.
    #[error("the coordinator is away: {0}")]
    Away(String),
    /// The coordinator will never take this worker.
    #[error("the coordinator refuses this worker: {0}")]
    Refused(String),
}

/// A coordinator, over HTTP or in the same process.
pub trait Coordinator: Send + Sync + 'static {
    /// Exchanges results for leases; a failure returns the results, to be sent again.
    fn exchange(
        &self,
        request: ExchangeRequest,
    ) -> impl Future<Output = Result<ExchangeResponse, (ExchangeError, Vec<WorkResult>)>> + Send;

    /// Fetches the variant of a hash; `None` if no active calibration uses it.
    fn variant(&self, hash: &str)
    -> impl Future<Output = Result<Option<ModelVariant>, ExchangeError>> + Send;
}
