//! The program `worker`: parses the command line, executes it, reports errors.

use std::io::Write as _;

use clap::Parser;
use shared::sentence::of_causes;
use tracing_subscriber::Layer as _;
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;
use worker::config::WorkerConfig;

fn main() -> std::process::ExitCode {
    // This check is first, because the processor may lack the instructions of any later code.
    if let Err(error) = worker::processor::check() {
        return refuse(error);
    }
    // This selects the cryptography of every connection; only a second call would fail.
    let _ = rustls::crypto::ring::default_provider().install_default();
    run()
}

#[tokio::main]
async fn run() -> std::process::ExitCode {
    let log = tracing_subscriber::fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr()));
    tracing_subscriber::registry()
        .with(log.with_filter(worker::config::log_filter()))
        .init();
    match worker::program::execute(WorkerConfig::parse()).await {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            let status = error.status();
            refuse(of_causes(anyhow::Error::from(error).chain()));
            status.into()
        }
    }
}

/// Reports why the program ends; it also ends if nothing can be written, as on a full disk.
fn refuse(error: impl std::fmt::Display) -> std::process::ExitCode {
    let _ = writeln!(std::io::stderr(), "error: {error}");
    std::process::ExitCode::FAILURE
}
