//! Command line and environment of the worker.

use std::path::PathBuf;

use shared::bearer::{BearerToken, BearerTokenError};
use shared::wire::WireForm;
use tracing_subscriber::filter::{LevelFilter, Targets};

/// Simulates wheel-soil contact for a Grouser coordinator.
#[derive(Debug, clap::Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
pub struct WorkerConfig {
    /// What to do besides serving a coordinator.
    #[command(subcommand)]
    pub command: Option<WorkerCommand>,
    /// How to serve a coordinator.
    #[command(flatten)]
    pub serve: Option<PullArguments>,
}

/// How to serve a coordinator.
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
    #[arg(long, value_name = "FILE")]
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
}

impl PullArguments {
    /// The token: of the file, or else of the environment.
    ///
    /// # Errors
    /// The file cannot be read, or the token has no form.
    pub fn token(&self) -> Result<Option<BearerToken>, BearerTokenError> {
        BearerToken::find(self.token_file.as_deref(), std::env::var("GROUSER_TOKEN").ok())
    }
}

/// What a worker does besides serving a coordinator.
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
        /// The folder; it is made where there is none.
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
    /// Address to listen on; whoever reaches it may have models evaluated.
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
    /// Where to write the averages of the wheel's runs, with the columns of runs.csv.
    #[arg(long, value_name = "CSV")]
    pub out: Option<PathBuf>,
    /// Where to write the pressures under the experiment's plates, with the columns of plates.csv.
    #[arg(long, value_name = "CSV")]
    pub plates: Option<PathBuf>,
    /// Runs this model, if it is that of the job: the file of a program, or the URL of a UM-Bridge server.
    #[arg(
        long,
        value_name = "FILE_OR_URL",
        env = "GROUSER_ALLOW_MODEL",
        value_delimiter = ','
    )]
    pub allow_model: Vec<String>,
    /// Where to write the shear stresses under the experiment's rings, with the columns of shear.csv.
    #[arg(long, value_name = "CSV")]
    pub shear: Option<PathBuf>,
}

/// What is logged: `RUST_LOG`, as a level or as `target=level` between commas, else `info`.
pub fn log_filter() -> Targets {
    let stated = std::env::var("RUST_LOG").ok().and_then(|text| text.parse().ok());
    stated.unwrap_or_else(|| Targets::new().with_default(LevelFilter::INFO))
}
