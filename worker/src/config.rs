//! Command line and environment of the worker.

use std::path::PathBuf;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use shared::bearer::{BearerToken, BearerTokenError};
use shared::wire::WireForm;
use tracing_subscriber::filter::{LevelFilter, Targets};

/// Simulates wheel-soil contact for a Grouser coordinator.
#[derive(Debug, clap::Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
pub struct WorkerConfig {
    /// The command, if the worker does not serve a coordinator.
    #[command(subcommand)]
    pub command: Option<WorkerCommand>,
    /// The arguments for serving a coordinator.
    #[command(flatten)]
    pub serve: Option<PullArguments>,
}

/// The arguments for serving a coordinator.
#[derive(Debug, clap::Args)]
pub struct PullArguments {
    /// The coordinator, as in `http://host:7070` or `https://farm.example`.
    #[arg(long, env = "GROUSER_COORDINATOR", value_name = "URL")]
    pub coordinator: String,
    /// Threads that simulate; by default, one for each core.
    #[arg(long, env = "GROUSER_THREADS")]
    pub threads: Option<std::num::NonZeroUsize>,
    /// Form of the messages: msgpack, or json to read along.
    #[arg(long, env = "GROUSER_WIRE", default_value_t = WireForm::MessagePack)]
    pub wire: WireForm,
    /// File with the token that the coordinator asks for; by default, `GROUSER_TOKEN` from the environment.
    #[arg(long, value_name = "FILE", env = "GROUSER_TOKEN_FILE")]
    pub token_file: Option<PathBuf>,
    /// Trusts a coordinator at an https URL by this certificate of its authority, a PEM file, in place of those of this machine.
    #[arg(long, value_name = "PEM", env = "GROUSER_CA_CERTIFICATE")]
    pub ca_certificate: Option<PathBuf>,
    /// Runs this model for jobs that name it: the file of a program (kind = "command"), or the URL of a UM-Bridge server (kind =
    /// "umbridge"); may be repeated, or several between commas. By default no job starts a program here.
    #[arg(
        long,
        value_name = "FILE_OR_URL",
        env = "GROUSER_ALLOW_MODEL",
        value_delimiter = ','
    )]
    pub allow_model: Vec<String>,
    /// Ends after this time without work `[s]`.
    #[arg(long, value_name = "SECONDS", env = "GROUSER_MAX_IDLE", value_parser = seconds)]
    pub max_idle: Option<Duration>,
    /// Returns unfinished evaluations and ends after this time `[s]`; by default, 30 s before the end of the Slurm job that the worker
    /// runs in.
    #[arg(long, value_name = "SECONDS", env = "GROUSER_MAX_LIFETIME", value_parser = seconds)]
    pub max_lifetime: Option<Duration>,
    /// Ends when no calibration is left that wants workers.
    #[arg(long)]
    pub once: bool,
    /// Returns unfinished evaluations and ends with status 75 when its process uses more memory than this `[MB]`.
    #[arg(long, value_name = "MB", env = "GROUSER_MAX_MEMORY_MB")]
    pub max_memory_mb: Option<u64>,
}

/// Parses a time in seconds, 0 to 10 years.
fn seconds(text: &str) -> Result<Duration, String> {
    const MAX_SECONDS: f64 = 315_360_000.0;
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=MAX_SECONDS).contains(&seconds) => Ok(Duration::from_secs_f64(seconds)),
        _ => Err(format!("must be a number of seconds in [0, {MAX_SECONDS}]")),
    }
}

/// Variables in which queues give the number of a job: name of the queue, number of the job, number within an array.
const QUEUES: [(&str, &str, &str); 4] = [
    ("slurm", "SLURM_JOB_ID", ""),
    ("hq", "HQ_JOB_ID", "HQ_TASK_ID"),
    ("pbs", "PBS_JOBID", ""),
    ("condor", "GROUSER_CONDOR_JOB", ""),
];

impl PullArguments {
    /// Returns the queue's job that this process belongs to, such as `slurm 1234_5`.
    pub fn queue_job(&self) -> Option<String> {
        queue_job(|name| std::env::var(name).ok())
    }

    /// Returns the time until the worker ends by itself: after its lifetime, or before the end of its Slurm job.
    pub fn ends_in(&self) -> Option<Duration> {
        /// Slurm's first signal may come this long before the end; a worker needs 5 s.
        const EARLY: Duration = Duration::from_secs(30);
        self.max_lifetime.or_else(|| {
            let end: u64 = std::env::var("SLURM_JOB_END_TIME").ok()?.parse().ok()?;
            let now = SystemTime::now().duration_since(UNIX_EPOCH).ok()?;
            Some(Duration::from_secs(end).saturating_sub(now).saturating_sub(EARLY))
        })
    }

    /// Reads the token from the file, or else from the environment; an error if the file cannot be read or the token is malformed.
    pub fn token(&self) -> Result<Option<BearerToken>, BearerTokenError> {
        BearerToken::find(self.token_file.as_deref(), std::env::var("GROUSER_TOKEN").ok())
    }
}

/// Finds the queue's job among the variables of a process.
fn queue_job(variable: impl Fn(&str) -> Option<String>) -> Option<String> {
    let set = |name: &str| variable(name).filter(|value| !value.is_empty());
    if let (Some(array), Some(task)) = (set("SLURM_ARRAY_JOB_ID"), set("SLURM_ARRAY_TASK_ID")) {
        return Some(format!("slurm {array}_{task}"));
    }
    if set("KUBERNETES_SERVICE_HOST").is_some() {
        return set("HOSTNAME").map(|pod| format!("kubernetes {pod}"));
    }
    QUEUES.iter().find_map(|(queue, job, task)| {
        let job = set(job)?;
        Some(match set(task) {
            Some(task) => format!("{queue} {job}_{task}"),
            None => format!("{queue} {job}"),
        })
    })
}

/// A command of the worker besides serving a coordinator.
#[derive(Debug, clap::Subcommand)]
pub enum WorkerCommand {
    /// Forward runs of an experiment, without a coordinator.
    Simulate(Simulate),
    /// Serves our models to other programs.
    Serve(ServeModels),
    /// Print completions of the command line for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Write the man pages of the program into a folder.
    Man {
        /// The folder; it is created if it does not exist.
        folder: PathBuf,
    },
}

/// Serves our models to other programs.
#[derive(Debug, clap::Args)]
pub struct ServeModels {
    /// By UM-Bridge, protocol 1.0: `quasi_static` and `scm`.
    #[arg(long, required = true)]
    pub umbridge: bool,
    /// Port to listen on; 0 takes a free one, which is printed.
    #[arg(long, default_value_t = 4242)]
    pub port: u16,
    /// Address to listen on; anyone who reaches it may have models evaluated.
    #[arg(long, default_value = "127.0.0.1")]
    pub address: std::net::IpAddr,
    /// Threads that simulate; by default, one for each core.
    #[arg(long, env = "GROUSER_THREADS")]
    pub threads: Option<std::num::NonZeroUsize>,
}

/// Forward runs of an experiment; at least one of `--out`, `--plates` and `--shear` must be given, one for each table.
#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("tables").required(true).multiple(true).args(["out", "plates", "shear"]))]
pub struct Simulate {
    /// The experiment; its measurements are not read, only its conditions.
    pub experiment: PathBuf,
    /// The model: the keys of a job's `[model]`, or a job file.
    #[arg(long)]
    pub model: PathBuf,
    /// The parameters: lines `name = value`.
    #[arg(long)]
    pub parameters: PathBuf,
    /// Adds noise of the experiment's standard deviations to the runs, drawn from this seed; plates and shear
    /// readings get no noise, because none is declared for them.
    #[arg(long, requires = "out")]
    pub noise_seed: Option<u64>,
    /// Folder for the time histories of each run, RUN.csv at 10 Hz (kind = "scm").
    #[arg(long, requires = "out")]
    pub histories: Option<PathBuf>,
    /// Writes the averages of the wheel's runs to this file, with the columns of runs.csv.
    #[arg(long, value_name = "CSV")]
    pub out: Option<PathBuf>,
    /// Writes the pressures under the experiment's plates to this file, with the columns of plates.csv.
    #[arg(long, value_name = "CSV")]
    pub plates: Option<PathBuf>,
    /// Runs this model if the job names it: the file of a program, or the URL of a UM-Bridge server.
    #[arg(
        long,
        value_name = "FILE_OR_URL",
        env = "GROUSER_ALLOW_MODEL",
        value_delimiter = ','
    )]
    pub allow_model: Vec<String>,
    /// Writes the shear stresses under the experiment's rings to this file, with the columns of shear.csv.
    #[arg(long, value_name = "CSV")]
    pub shear: Option<PathBuf>,
}

/// Returns the log filter: `RUST_LOG`, a level or comma-separated `target=level`, else `info`.
pub fn log_filter() -> Targets {
    let stated = std::env::var("RUST_LOG").ok().and_then(|text| text.parse().ok());
    stated.unwrap_or_else(|| Targets::new().with_default(LevelFilter::INFO))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_job_of_each_queue_is_recognised() {
        let job_of = |variables: &[(&str, &str)]| {
            let variable = |name: &str| variables.iter().find(|(candidate, _)| *candidate == name);
            queue_job(|name| variable(name).map(|(_, value)| (*value).to_owned()))
        };
        let job = |text: &str| Some(text.to_owned());
        assert_eq!(job_of(&[("SLURM_JOB_ID", "7")]), job("slurm 7"));
        let array = [
            ("SLURM_JOB_ID", "9"),
            ("SLURM_ARRAY_JOB_ID", "7"),
            ("SLURM_ARRAY_TASK_ID", "2"),
        ];
        assert_eq!(job_of(&array), job("slurm 7_2"));
        assert_eq!(job_of(&[("HQ_JOB_ID", "3"), ("HQ_TASK_ID", "0")]), job("hq 3_0"));
        let pod = [("KUBERNETES_SERVICE_HOST", "10.0.0.1"), ("HOSTNAME", "worker-x")];
        assert_eq!(job_of(&pod), job("kubernetes worker-x"));
        assert_eq!(job_of(&[("HOSTNAME", "h"), ("PBS_JOBID", "")]), None);
    }

    #[test]
    fn times_are_seconds_within_bounds() {
        assert_eq!(seconds("2.5"), Ok(Duration::from_millis(2500)));
        for wrong in ["-1", "nan", "1e300", "5 min"] {
            assert!(seconds(wrong).unwrap_err().contains("seconds in [0,"), "{wrong}");
        }
    }
}
