//! The loop of a worker: exchange, evaluate, resend, renew, give back.
//!
//! # Layout
//! - This file: the start of the loop.
//! - `worker`: the loop.
//! - [`exchange`]: the interface of a coordinator for the loop.
//! - `settings`: identity and settings of a worker. [`limits`]: the limits of its service, and the reason of its end.

pub mod exchange;
pub mod limits;
mod settings;
#[cfg(test)]
mod tests;
mod worker;

use std::sync::Arc;

use crate::evaluator::{Evaluator, SimulationClock};
use exchange::{Coordinator, ExchangeError};
use limits::Ended;
pub use settings::PullSettings;
use worker::Worker;

/// Runs until `shutdown` is ready or a limit is reached; then, within 5 s, gives back the leases that are not finished.
///
/// # Errors
/// [`ExchangeError::Refused`], also if the threads cannot be started, because retrying would not help.
pub async fn run<C: Coordinator>(
    coordinator: Arc<C>,
    settings: PullSettings,
    clock: Arc<SimulationClock>,
    shutdown: impl Future<Output = ()>,
) -> Result<Ended, ExchangeError> {
    let evaluator = Evaluator::new(settings.threads, clock.clone())
        .map_err(|e| ExchangeError::Refused(format!("no threads: {e}")))?;
    Worker::new(coordinator, settings, evaluator, clock)
        .run(shutdown)
        .await
}
