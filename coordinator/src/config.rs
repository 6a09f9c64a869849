//! Command line and environment of the coordinator.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use tracing_subscriber::filter::{LevelFilter, Targets};

/// Finds the physics that a wheel-soil model is missing.
#[derive(Debug, Parser)]
#[command(version, name = "coordinator")]
pub struct Config {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Calibrate in one process: coordinator, local workers, results in a folder. Run again to go on.
    Run(Run),
    /// Validate a job and say what it will cost.
    Check(JobFile),
    /// Run the service: REST interface and workers' endpoint.
    Serve(Serve),
    /// Send a job to a service.
    Submit(Submit),
    /// List calibrations.
    List(Source),
    /// Say where a calibration stands.
    Status(Target),
    /// Stop a calibration for good.
    Cancel(Target),
    /// Lease no more evaluations of a calibration.
    Pause(Target),
    /// Go on with a paused calibration.
    Resume(Target),
    /// Compare model and measurement, run by run.
    Compare(Target),
    /// Write a calibration's report.
    Report(Report),
    /// Write a calibration's draws and comparison.
    Export(Export),
    /// Say how far a calibration can be trusted, and where its model fails.
    Diagnose(Target),
    /// Find the effect that a calibration's model misses.
    Discover(Discover),
    /// Add to a study a calibration with an effect more.
    Extend(Extend),
    /// Add measurements to a study, and a calibration of all of them.
    AddRuns(AddRuns),
    /// List the effects that a model may miss, or show one: its file, and what it does.
    Effects(Effects),
}

/// A job file, and effects that it does not name itself.
#[derive(Debug, Args)]
pub struct JobFile {
    /// The job.
    pub job: PathBuf,
    /// Adds an effect of the catalogue to the job; may be repeated.
    #[arg(long, value_name = "NAME")]
    pub effect: Vec<String>,
    /// Adds the effect of a file to the job; may be repeated.
    #[arg(long, value_name = "FILE")]
    pub effect_file: Vec<PathBuf>,
}

/// List the effects, or show one.
#[derive(Debug, Args)]
pub struct Effects {
    /// An effect of the catalogue; by default, all of them are listed.
    #[arg(conflicts_with = "file")]
    pub name: Option<String>,
    /// Shows the effect of this file instead.
    #[arg(long)]
    pub file: Option<PathBuf>,
    /// The model in which its deeds are shown.
    #[arg(long, value_enum, default_value_t = Model::QuasiStatic)]
    pub model: Model,
}

/// A forward model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Model {
    /// The smooth rim in steady motion.
    #[value(name = "quasi_static")]
    QuasiStatic,
    /// The wheel that rolls over deformable terrain.
    Scm,
}

/// Calibrate in one process.
#[derive(Debug, Args)]
pub struct Run {
    /// The job.
    #[command(flatten)]
    pub file: JobFile,
    /// Where results and store go; by default out/NAME, after the job file or its folder.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads that simulate here; by default, one for each core.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS")]
    pub local_workers: Option<usize>,
    /// Lets workers elsewhere join at this address.
    #[arg(long, value_name = "ADDR")]
    pub listen: Option<std::net::SocketAddr>,
}

/// Run the service.
#[derive(Debug, Args)]
pub struct Serve {
    /// Address to listen on.
    #[arg(long, env = "GROUSER_LISTEN", default_value = "127.0.0.1:7070")]
    pub listen: std::net::SocketAddr,
    /// The store.
    #[arg(
        long,
        env = "GROUSER_STORE",
        default_value = "sqlite://grouser.db",
        value_name = "sqlite://FILE"
    )]
    pub store: String,
    /// Threads that simulate in this process.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS", default_value_t = 0)]
    pub local_workers: usize,
    /// How long a lease lasts without renewal `[ms]`.
    #[arg(long, env = "GROUSER_LEASE_MS", default_value_t = crate::service::LEASE_MS)]
    pub lease_ms: u64,
}

/// Send a job to a service.
#[derive(Debug, Args)]
pub struct Submit {
    /// The job.
    #[command(flatten)]
    pub file: JobFile,
    /// The service.
    #[arg(long, env = "GROUSER_URL", default_value = "http://127.0.0.1:7070")]
    pub url: String,
}

/// Where calibrations are looked up.
#[derive(Debug, Args)]
#[group(multiple = false)]
pub struct Source {
    /// A service; by default, the one of `GROUSER_URL` in the environment, or port 7070 of this machine.
    #[arg(long)]
    pub url: Option<String>,
    /// The folder of a run.
    #[arg(long)]
    pub out: Option<PathBuf>,
}

impl Source {
    /// The service: the one named, or the environment's, which a folder that is named outdoes.
    pub fn url(&self) -> String {
        let environment = || std::env::var("GROUSER_URL").ok();
        self.url
            .clone()
            .or_else(environment)
            .unwrap_or_else(|| "http://127.0.0.1:7070".into())
    }
}

/// One calibration.
#[derive(Debug, Args)]
pub struct Target {
    /// The calibration's id; may be left out where there is only one.
    pub id: Option<i64>,
    /// Where it is.
    #[command(flatten)]
    pub source: Source,
}

/// Write a calibration's report.
#[derive(Debug, Args)]
pub struct Report {
    /// Which calibration.
    #[command(flatten)]
    pub target: Target,
    /// Where to write it; by default, standard output.
    #[arg(long)]
    pub output: Option<PathBuf>,
}

/// Write a calibration's draws and comparison.
#[derive(Debug, Args)]
pub struct Export {
    /// Which calibration.
    #[command(flatten)]
    pub target: Target,
    /// csv: the posterior; json: summary, posterior and comparison.
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    pub format: Format,
    /// Where to write it; by default, standard output.
    #[arg(long)]
    pub output: Option<PathBuf>,
}

/// Format of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Equally weighted draws, one a row.
    Csv,
    /// Summary, posterior and comparison.
    Json,
}

/// Find the effect that a calibration's model misses.
#[derive(Debug, Args)]
pub struct Discover {
    /// Which calibration.
    #[command(flatten)]
    pub target: Target,
    /// Threads that simulate here, for a folder; by default, one for each core.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS")]
    pub local_workers: Option<usize>,
}

/// Add to a study a calibration with an effect more.
#[derive(Debug, Args)]
pub struct Extend {
    /// Which calibration is extended.
    #[command(flatten)]
    pub target: Target,
    /// An effect of the catalogue.
    #[arg(
        long,
        value_name = "NAME",
        required_unless_present = "effect_file",
        conflicts_with = "effect_file"
    )]
    pub effect: Option<String>,
    /// The effect of a file.
    #[arg(long, value_name = "FILE")]
    pub effect_file: Option<PathBuf>,
    /// The effect acts on this wheel alone, of several.
    #[arg(long, value_name = "NAME", requires = "effect")]
    pub wheel: Option<String>,
    /// Threads that simulate here, for a folder; by default, one for each core.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS")]
    pub local_workers: Option<usize>,
}

/// Add measurements to a study.
#[derive(Debug, Args)]
pub struct AddRuns {
    /// A calibration of the study.
    pub id: i64,
    /// Rows with a header, as in runs.csv.
    pub runs: PathBuf,
    /// Where it is.
    #[command(flatten)]
    pub source: Source,
    /// Threads that simulate here, for a folder; by default, one for each core.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS")]
    pub local_workers: Option<usize>,
}

/// What is logged: `RUST_LOG`, as a level or as `target=level` between commas, else `info,sqlx::query=warn`.
pub fn log_filter() -> Targets {
    let stated = std::env::var("RUST_LOG").ok().and_then(|text| text.parse().ok());
    stated.unwrap_or_else(|| {
        Targets::new()
            .with_default(LevelFilter::INFO)
            .with_target("sqlx::query", LevelFilter::WARN)
    })
}
