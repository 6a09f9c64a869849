//! Arguments of `coordinator scale`.

use std::path::PathBuf;

use clap::Args;

use super::client::ClientArguments;

/// What starts workers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum EngineKind {
    /// Arrays of jobs, by `sbatch`, `squeue` and `scancel`.
    Slurm,
    /// Jobs of HyperQueue, by `hq`; its allocator gets machines from Slurm or PBS.
    #[value(name = "hyperqueue")]
    HyperQueue,
    /// Replicas of a deployment, by `kubectl`.
    Kubernetes,
}

/// Start and end workers on machines of a queue, by the work that a service has.
#[derive(Debug, Args)]
pub struct ScaleArguments {
    /// What starts the workers.
    #[arg(value_enum)]
    pub engine: EngineKind,
    /// URL of the service.
    #[arg(long, env = "GROUSER_URL", default_value = "http://127.0.0.1:7070")]
    pub url: String,
    #[command(flatten)]
    pub client: ClientArguments,
    /// URL of the service as workers reach it; by default, that of `--url`.
    #[arg(long, value_name = "URL")]
    pub worker_url: Option<String>,
    /// The program `worker` on machines of Slurm and HyperQueue, where it is not in PATH.
    #[arg(long, value_name = "FILE", env = "GROUSER_WORKER", default_value = "worker")]
    pub worker: String,
    /// Name of the jobs, or of the deployment; what has it counts as a pilot of this service.
    #[arg(long, default_value = "grouser-worker")]
    pub name: String,
    /// Minimum number of pilots, which are kept even without work.
    #[arg(long, default_value_t = 0)]
    pub min: u32,
    /// Maximum number of pilots.
    #[arg(long)]
    pub max: u32,
    /// Threads of each pilot.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: u32,
    /// Starts as many pilots as finish the remaining work within this time `[s]`.
    #[arg(long, value_name = "SECONDS", default_value_t = 600.0, value_parser = positive)]
    pub finish_within: f64,
    /// A pilot without work ends after this time `[s]`.
    #[arg(long, value_name = "SECONDS", default_value_t = 120.0, value_parser = positive)]
    pub max_idle: f64,
    /// Cancels all pilots, and ends, when those that it saw running have cost this many thread hours.
    #[arg(long, value_name = "HOURS", conflicts_with = "once", value_parser = positive)]
    pub cost_cap_thread_h: Option<f64>,
    /// Looks so often `[s]`.
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, value_parser = positive)]
    pub every: f64,
    /// Looks once, and ends: for cron.
    #[arg(long)]
    pub once: bool,
    /// The batch script of a pilot of Slurm, in place of the one that `deploy/slurm/pilot.sh` shows.
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// Options for sbatch, `hq submit` or kubectl, behind `--`.
    #[arg(last = true, value_name = "OPTION")]
    pub options: Vec<String>,
}

/// Returns a positive number of at most ten years in seconds.
fn positive(text: &str) -> Result<f64, String> {
    const MAX_SECONDS: f64 = 315_360_000.0;
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= MAX_SECONDS => Ok(value),
        _ => Err(format!("must be a number in (0, {MAX_SECONDS}]")),
    }
}
