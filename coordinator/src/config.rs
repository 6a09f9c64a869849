//! Command line and environment of the coordinator.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use tracing_subscriber::filter::{LevelFilter, Targets};

/// Finds the physics that a wheel-soil model is missing.
#[derive(Debug, Parser)]
#[command(version, name = "coordinator")]
pub struct CoordinatorConfig {
    /// What to do.
    #[command(subcommand)]
    pub command: CoordinatorCommand,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum CoordinatorCommand {
    /// Calibrate in one process: coordinator, local workers, results in a folder. Run again to go on.
    Run(RunArguments),
    /// Validate a job and say what it will cost.
    Check(JobArguments),
    /// Run the service: REST interface and workers' endpoint.
    Serve(ServeArguments),
    /// Send a job to a service.
    Submit(SubmitArguments),
    /// List calibrations.
    List(SourceArguments),
    /// Say where a calibration stands.
    Status(TargetArguments),
    /// Stop a calibration for good.
    Cancel(TargetArguments),
    /// Lease no more evaluations of a calibration.
    Pause(TargetArguments),
    /// Go on with a paused calibration.
    Resume(TargetArguments),
    /// Compare model and measurement, run by run.
    Compare(TargetArguments),
    /// Write a calibration's report.
    Report(ReportArguments),
    /// Write a calibration's draws and comparison.
    Export(ExportArguments),
    /// Say how far a calibration can be trusted, and where its model fails.
    Diagnose(TargetArguments),
    /// Find the effect that a calibration's model misses.
    Discover(DiscoverArguments),
    /// Add to a study a calibration with an effect more.
    Extend(ExtendArguments),
    /// Add measurements to a study, and a calibration of all of them.
    AddRuns(AddRunsArguments),
    /// List the effects that a model may miss, or show one: its file, and what it does.
    Effects(EffectsArguments),
}

/// A job file, and effects that it does not name itself.
#[derive(Debug, Args)]
pub struct JobArguments {
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
pub struct EffectsArguments {
    /// An effect of the catalogue; by default, all of them are listed.
    #[arg(conflicts_with = "file")]
    pub name: Option<String>,
    /// Shows the effect of this file instead.
    #[arg(long)]
    pub file: Option<PathBuf>,
    /// The model in which its deeds are shown.
    #[arg(long, value_enum, default_value_t = ModelChoice::QuasiStatic)]
    pub model: ModelChoice,
}

/// A forward model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ModelChoice {
    /// The smooth rim in steady motion.
    #[value(name = "quasi_static")]
    QuasiStatic,
    /// The wheel that rolls over deformable terrain.
    Scm,
}

/// Calibrate in one process.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// The job.
    #[command(flatten)]
    pub file: JobArguments,
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
pub struct ServeArguments {
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
pub struct SubmitArguments {
    /// The job.
    #[command(flatten)]
    pub file: JobArguments,
    /// The service.
    #[arg(long, env = "GROUSER_URL", default_value = "http://127.0.0.1:7070")]
    pub url: String,
}

/// Where calibrations are looked up.
#[derive(Debug, Args)]
#[group(multiple = false)]
pub struct SourceArguments {
    /// A service; by default, the one of `GROUSER_URL` in the environment, or port 7070 of this machine.
    #[arg(long)]
    pub url: Option<String>,
    /// The folder of a run.
    #[arg(long)]
    pub out: Option<PathBuf>,
}

impl SourceArguments {
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
pub struct TargetArguments {
    /// The calibration's id; may be left out where there is only one.
    pub id: Option<i64>,
    /// Where it is.
    #[command(flatten)]
    pub source: SourceArguments,
}

/// Write a calibration's report.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// Which calibration.
    #[command(flatten)]
    pub target: TargetArguments,
    /// Where to write it; by default, standard output.
    #[arg(long)]
    pub output: Option<PathBuf>,
}

/// Write a calibration's draws and comparison.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Which calibration.
    #[command(flatten)]
    pub target: TargetArguments,
    /// csv: the posterior; json: summary, posterior and comparison.
    #[arg(long, value_enum, default_value_t = ExportFormat::Csv)]
    pub format: ExportFormat,
    /// Where to write it; by default, standard output.
    #[arg(long)]
    pub output: Option<PathBuf>,
}

/// Format of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ExportFormat {
    /// Equally weighted draws, one a row.
    Csv,
    /// Summary, posterior and comparison.
    Json,
}

/// Find the effect that a calibration's model misses.
#[derive(Debug, Args)]
pub struct DiscoverArguments {
    /// Which calibration.
    #[command(flatten)]
    pub target: TargetArguments,
    /// Threads that simulate here, for a folder; by default, one for each core.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS")]
    pub local_workers: Option<usize>,
}

/// Add to a study a calibration with an effect more.
#[derive(Debug, Args)]
pub struct ExtendArguments {
    /// Which calibration is extended.
    #[command(flatten)]
    pub target: TargetArguments,
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
pub struct AddRunsArguments {
    /// A calibration of the study.
    pub id: i64,
    /// Rows with a header, as in runs.csv.
    pub runs: PathBuf,
    /// Where it is.
    #[command(flatten)]
    pub source: SourceArguments,
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
