//! The program `worker`: the execution of its command line, also as a verb of the coordinator.

use std::io::{self, Write as _};
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Instant;

use shared::bearer::BearerTokenError;
use tokio::runtime::Handle;

use crate::client::{ClientError, HttpCoordinator};
use crate::config::{PullArguments, ServeModels, WorkerCommand, WorkerConfig};
use crate::evaluator::SimulationClock;
use crate::external::allowed::{AllowedModelError, AllowedModels};
use crate::pull::exchange::ExchangeError;
use crate::pull::limits::{Ended, WorkerLimits};
use crate::pull::{PullSettings, run};
use crate::shell;
use crate::simulate::{SimulateError, simulate};

/// `EX_UNAVAILABLE` of sysexits(3): the coordinator refuses this worker permanently.
const REFUSED: u8 = 69;
/// `EX_TEMPFAIL`: another process may continue.
const TRY_AGAIN: u8 = 75;

/// Why the program ends early.
#[derive(Debug, thiserror::Error)]
pub enum ProgramError {
    /// The URL of the coordinator is missing.
    #[error("--coordinator URL is missing")]
    NoCoordinator,
    /// The token cannot be read.
    #[error(transparent)]
    Token(#[from] BearerTokenError),
    /// The coordinator cannot be addressed.
    #[error(transparent)]
    Client(#[from] ClientError),
    /// The handlers of stop signals cannot be installed.
    #[error("signals")]
    Signals(#[source] io::Error),
    /// The coordinator refuses the worker.
    #[error("worker")]
    Exchange(#[from] ExchangeError),
    /// The process exceeds its memory limit; unfinished work is given back.
    #[error("the process holds more than --max-memory-mb {0} MB")]
    Memory(u64),
    /// Completions cannot be written.
    #[error("standard output")]
    Output(#[source] io::Error),
    /// The man pages cannot be written.
    #[error("{folder}")]
    Man {
        /// Path of the folder.
        folder: String,
        /// The operating system's reason.
        #[source]
        cause: io::Error,
    },
    /// An external model cannot be run.
    #[error(transparent)]
    Model(#[from] AllowedModelError),
    /// Models cannot be served.
    #[error("serve")]
    Serve(#[source] io::Error),
    /// The port cannot be listened on.
    #[error("--port {address}")]
    Port {
        /// Address and port.
        address: SocketAddr,
        /// The operating system's reason.
        #[source]
        cause: io::Error,
    },
    /// The thread of the forward runs ended early.
    #[error("forward runs")]
    Thread(#[source] tokio::task::JoinError),
    /// The forward runs failed.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}

impl ProgramError {
    /// Returns the exit status for this error.
    pub fn status(&self) -> u8 {
        match self {
            ProgramError::Exchange(ExchangeError::Refused(_)) => REFUSED,
            ProgramError::Memory(_) => TRY_AGAIN,
            _ => 1,
        }
    }
}

/// Serves a coordinator until a signal or a limit ends it, or executes the command.
pub async fn execute(config: WorkerConfig) -> Result<(), ProgramError> {
    match (config.command, config.serve) {
        (Some(WorkerCommand::Simulate(command)), _) => {
            let models = AllowedModels::new(&command.allow_model, &Handle::current())?;
            let done = tokio::task::spawn_blocking(move || simulate(&command, &Arc::new(models)));
            Ok(done.await.map_err(ProgramError::Thread)??)
        }
        (Some(WorkerCommand::Serve(command)), _) => serve(&command).await,
        (Some(WorkerCommand::Completions { shell }), _) => {
            shell::completions(shell, &mut io::stdout()).map_err(ProgramError::Output)
        }
        (Some(WorkerCommand::Man { folder }), _) => shell::man(&folder).map_err(|cause| ProgramError::Man {
            folder: folder.display().to_string(),
            cause,
        }),
        (None, Some(serve)) => pull(&serve).await,
        (None, None) => Err(ProgramError::NoCoordinator),
    }
}

async fn serve(command: &ServeModels) -> Result<(), ProgramError> {
    let address = SocketAddr::new(command.address, command.port);
    let on_port = |cause| ProgramError::Port { address, cause };
    let listener = tokio::net::TcpListener::bind(address).await.map_err(on_port)?;
    let cores = std::thread::available_parallelism().map_or(1, Into::into);
    let threads = command.threads.map_or(cores, Into::into);
    // A script that requested a free port reads its number here.
    let bound = listener.local_addr().map_err(on_port)?;
    writeln!(io::stdout(), "http://{bound}").map_err(ProgramError::Output)?;
    let stop = stop_signal().map_err(ProgramError::Signals)?;
    crate::serve::serve(listener, threads, stop)
        .await
        .map_err(ProgramError::Serve)
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
    let name = unique_name();
    tracing::info!(
        name,
        threads,
        coordinator = serve.coordinator,
        model = crate::model_version(),
        "worker"
    );
    let clock = Arc::new(SimulationClock::default());
    let stop = stop_signal().map_err(ProgramError::Signals)?;
    let settings = PullSettings {
        name,
        queue_job: serve.queue_job(),
        threads,
        limits: WorkerLimits {
            max_idle: serve.max_idle,
            ends_at: serve.ends_in().map(|time| Instant::now() + time),
            once: serve.once,
            max_memory_mb: serve.max_memory_mb,
        },
        models: Arc::new(AllowedModels::new(&serve.allow_model, &Handle::current())?),
    };
    match run(Arc::new(coordinator), settings, clock, stop).await? {
        Ended::Memory => Err(ProgramError::Memory(serve.max_memory_mb.unwrap_or_default())),
        Ended::Asked | Ended::Idle | Ended::Lifetime | Ended::NothingLeft => Ok(()),
    }
}

/// Builds a name from host, process and time: fresh for every process, so that a new worker never inherits a dead worker's leases.
fn unique_name() -> String {
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

/// Returns a future that is ready at ^C, SIGTERM, or SIGUSR1, which sites configure as Slurm's signal before the end of a
/// job.
fn stop_signal() -> io::Result<impl Future<Output = ()>> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut terminate = signal(SignalKind::terminate())?;
    let mut announced = signal(SignalKind::user_defined1())?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = announced.recv() => {}
            _ = tokio::signal::ctrl_c() => {}
        }
    })
}
