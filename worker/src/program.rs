//! What the program `worker` does with its command line, for that program and for the verb of the coordinator.

use std::io;
use std::sync::Arc;

use shared::bearer::BearerTokenError;

use crate::client::{ClientError, HttpCoordinator};
use crate::config::{PullArguments, WorkerCommand, WorkerConfig};
use crate::evaluator::SimulationClock;
use crate::pull::{ExchangeError, PullSettings, run};
use crate::simulate::{SimulateError, simulate};

/// Why the program ends early.
#[derive(Debug, thiserror::Error)]
pub enum ProgramError {
    /// It is not said whom to serve.
    #[error("--coordinator URL is missing")]
    NoCoordinator,
    /// There is no token.
    #[error(transparent)]
    Token(#[from] BearerTokenError),
    /// The coordinator cannot be addressed.
    #[error(transparent)]
    Client(#[from] ClientError),
    /// The signals that stop it cannot be heard.
    #[error("signals")]
    Signals(#[source] io::Error),
    /// The coordinator refuses the worker.
    #[error("worker")]
    Exchange(#[from] ExchangeError),
    /// There are no forward runs.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}

/// Serves a coordinator until ^C or SIGTERM, or simulates.
///
/// # Errors
/// [`ProgramError`].
pub async fn execute(config: WorkerConfig) -> Result<(), ProgramError> {
    match (config.command, config.serve) {
        (Some(WorkerCommand::Simulate(command)), _) => Ok(simulate(&command)?),
        (None, Some(serve)) => pull(&serve).await,
        (None, None) => Err(ProgramError::NoCoordinator),
    }
}

async fn pull(serve: &PullArguments) -> Result<(), ProgramError> {
    let coordinator = HttpCoordinator::new(
        &serve.coordinator,
        serve.ca_certificate.as_deref(),
        serve.wire,
        serve.token()?,
    )?;
    let cores = std::thread::available_parallelism().map_or(1, Into::into);
    let threads = serve.threads.map_or(cores, Into::into);
    let name = name();
    tracing::info!(
        name,
        threads,
        coordinator = serve.coordinator,
        model = crate::model_version(),
        "worker"
    );
    let clock = Arc::new(SimulationClock::default());
    let stop = stop_signal().map_err(ProgramError::Signals)?;
    Ok(run(Arc::new(coordinator), PullSettings { name, threads }, clock, stop).await?)
}

/// Host, process and time: fresh for every process, so a dead worker's leases are never taken for a new one's.
fn name() -> String {
    let host = std::fs::read_to_string("/etc/hostname").unwrap_or_default();
    let host = host.trim();
    let since = std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .map_or(0, |d| d.as_millis());
    format!(
        "{}-{}-{since:x}",
        if host.is_empty() { "worker" } else { host },
        std::process::id()
    )
}

/// Ready at ^C or SIGTERM.
fn stop_signal() -> io::Result<impl Future<Output = ()>> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut terminate = signal(SignalKind::terminate())?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = tokio::signal::ctrl_c() => {}
        }
    })
}
