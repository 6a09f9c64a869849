//! The program `coordinator`: parses the command line, executes the command, reports errors.

use std::io::Write as _;

use clap::Parser;
use coordinator::command::Stopped;
use coordinator::config::CoordinatorConfig;
use shared::sentence::of_causes;
use tracing_subscriber::Layer as _;
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;

fn main() -> std::process::ExitCode {
    // This check comes first, because the processor may lack instructions of the code that follows.
    if let Err(error) = coordinator::embedded::check_processor() {
        return refuse(error);
    }
    // The cryptography of every connection is installed once; only a second call would fail.
    let _ = rustls::crypto::ring::default_provider().install_default();
    run()
}

#[tokio::main]
async fn run() -> std::process::ExitCode {
    let config = CoordinatorConfig::parse();
    let log = tracing_subscriber::fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr()));
    tracing_subscriber::registry()
        .with(log.with_filter(config.command.log_filter()))
        .init();
    match coordinator::command::execute(config.command).await {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => match error.downcast_ref::<Stopped>() {
            Some(stopped) => {
                let _ = writeln!(std::io::stderr(), "{stopped}");
                std::process::ExitCode::from(stopped.exit_status())
            }
            None => {
                let status = refuse(of_causes(error.chain()));
                let worker = error.downcast_ref::<coordinator::embedded::WorkerError>();
                worker.map_or(status, |error| error.status().into())
            }
        },
    }
}

/// Prints why the program ends. If standard error cannot be written, as on a full disk, the program ends nevertheless.
fn refuse(error: impl std::fmt::Display) -> std::process::ExitCode {
    let _ = writeln!(std::io::stderr(), "error: {error}");
    std::process::ExitCode::FAILURE
}
