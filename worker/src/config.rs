//! Command line and environment of the worker.

use std::path::PathBuf;

/// Simulates wheel-soil contact for a Grouser coordinator.
#[derive(Debug, clap::Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
pub struct Config {
    /// What to do besides serving a coordinator.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// How to serve a coordinator.
    #[command(flatten)]
    pub serve: Option<Serve>,
}

/// How to serve a coordinator.
#[derive(Debug, clap::Args)]
pub struct Serve {
    /// The coordinator, as in `http://host:7070`.
    #[arg(long, env = "GROUSER_COORDINATOR", value_name = "URL")]
    pub coordinator: String,
    /// Threads that simulate; by default, one for each core.
    #[arg(long, env = "GROUSER_THREADS")]
    pub threads: Option<std::num::NonZeroUsize>,
}

/// What else a worker does.
#[derive(Debug, clap::Subcommand)]
pub enum Command {
    /// Forward runs of an experiment, without a coordinator.
    Simulate(Simulate),
}

/// Forward runs of an experiment.
#[derive(Debug, clap::Args)]
pub struct Simulate {
    /// The experiment; its measurements are not read, only its conditions.
    pub experiment: PathBuf,
    /// The model: the keys of a job's `[model]`, or a job file.
    #[arg(long)]
    pub model: PathBuf,
    /// The parameters: lines `name = value`.
    #[arg(long)]
    pub parameters: PathBuf,
    /// Adds noise of the experiment's standard deviations, drawn from this seed.
    #[arg(long)]
    pub noise_seed: Option<u64>,
    /// Where to write time histories (a model that has them: not in this version).
    #[arg(long)]
    pub histories: Option<PathBuf>,
    /// Where to write the averages, with the columns of runs.csv.
    #[arg(long)]
    pub out: PathBuf,
}
