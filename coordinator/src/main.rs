//! The program `coordinator`: parse, carry out, say what went wrong.

use clap::Parser;
use coordinator::config::Config;
use shared::sentence::of_causes;

fn main() -> std::process::ExitCode {
    if let Err(error) = coordinator::embedded::check_processor() {
        eprintln!("error: {error}");
        return std::process::ExitCode::FAILURE;
    }
    run()
}

#[tokio::main]
async fn run() -> std::process::ExitCode {
    let config = Config::parse();
    tracing_subscriber::fmt()
        .with_env_filter(
            tracing_subscriber::EnvFilter::try_from_default_env()
                .unwrap_or_else(|_| "info,sqlx::query=warn".into()),
        )
        .with_writer(std::io::stderr)
        .with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr()))
        .init();
    match coordinator::command::execute(config.command).await {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", of_causes(error.chain()));
            std::process::ExitCode::FAILURE
        }
    }
}
