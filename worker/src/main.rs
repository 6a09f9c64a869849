//! The program `worker`: parse, connect, run.

use std::io::Write as _;
use std::net::SocketAddr;
use std::sync::Arc;

use anyhow::Context;
use clap::Parser;
use shared::sentence::of_causes;
use tracing_subscriber::Layer as _;
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;
use worker::client::HttpCoordinator;
use worker::config::{PullArguments, ServeModels, WorkerCommand, WorkerConfig};
use worker::evaluator::SimulationClock;
use worker::external::allowed::AllowedModels;
use worker::pull::{PullSettings, run};

fn main() -> std::process::ExitCode {
    // The cryptography of every connection; only a second call would fail.
    let _ = rustls::crypto::ring::default_provider().install_default();
    if let Err(error) = worker::processor::check() {
        return refuse(error);
    }
    let log = tracing_subscriber::fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr()));
    tracing_subscriber::registry()
        .with(log.with_filter(worker::config::log_filter()))
        .init();
    let config = WorkerConfig::parse();
    let done = match (config.command, config.serve) {
        (Some(WorkerCommand::Simulate(command)), _) => simulate(&command),
        (Some(WorkerCommand::Serve(command)), _) => serve(&command),
        (None, Some(serve)) => pull(&serve),
        (None, None) => Err(anyhow::anyhow!("--coordinator URL is missing")),
    };
    match done {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => refuse(of_causes(error.chain())),
    }
}

/// Says why the program ends; where nothing can be written, as on a full disk, it ends all the same.
fn refuse(error: impl std::fmt::Display) -> std::process::ExitCode {
    let _ = writeln!(std::io::stderr(), "error: {error}");
    std::process::ExitCode::FAILURE
}

/// A server is talked to on a runtime, by a thread that waits.
fn simulate(command: &worker::config::Simulate) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Runtime::new()?;
    let models = AllowedModels::new(&command.allow_model, runtime.handle())?;
    Ok(worker::simulate::simulate(command, &Arc::new(models))?)
}

#[tokio::main]
async fn serve(command: &ServeModels) -> anyhow::Result<()> {
    let address = SocketAddr::new(command.address, command.port);
    let listener = tokio::net::TcpListener::bind(address).await;
    let listener = listener.with_context(|| format!("--port {address}"))?;
    let cores = std::thread::available_parallelism().map_or(1, Into::into);
    let threads = command.threads.map_or(cores, Into::into);
    // A script that asked for a free port reads it here.
    writeln!(std::io::stdout(), "http://{}", listener.local_addr()?)?;
    worker::serve::serve(listener, threads, stop_signal()?)
        .await
        .context("serve")
}

#[tokio::main]
async fn pull(serve: &PullArguments) -> anyhow::Result<()> {
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
        model = worker::model_version(),
        "worker"
    );
    let models = AllowedModels::new(&serve.allow_model, &tokio::runtime::Handle::current())?;
    let clock = Arc::new(SimulationClock::default());
    run(
        Arc::new(coordinator),
        PullSettings {
            name,
            threads,
            models: Arc::new(models),
        },
        clock,
        stop_signal()?,
    )
    .await
    .context("worker")
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
fn stop_signal() -> anyhow::Result<impl Future<Output = ()>> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut terminate = signal(SignalKind::terminate()).context("signals")?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = tokio::signal::ctrl_c() => {}
        }
    })
}
