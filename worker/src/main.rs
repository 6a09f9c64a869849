//! The program `worker`: parse, connect, run.

use std::io::Write as _;
use std::sync::Arc;

use anyhow::Context;
use clap::Parser;
use shared::sentence::of_causes;
use tracing_subscriber::Layer as _;
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;
use worker::client::HttpCoordinator;
use worker::config::{PullArguments, WorkerCommand, WorkerConfig};
use worker::evaluator::SimulationClock;
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
        (Some(WorkerCommand::Simulate(command)), _) => {
            worker::simulate::simulate(&command).map_err(Into::into)
        }
        (Some(WorkerCommand::Completions { shell }), _) => {
            worker::shell::completions(shell, &mut std::io::stdout()).map_err(Into::into)
        }
        (Some(WorkerCommand::Man { folder }), _) => {
            worker::shell::man(&folder).with_context(|| folder.display().to_string())
        }
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
    let clock = Arc::new(SimulationClock::default());
    run(
        Arc::new(coordinator),
        PullSettings { name, threads },
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
