//! Command line and environment of the coordinator.
//!
//! # Layout
//! - `client`: what a service asks for.
//! - `law`: arguments of `coordinator library`.
//! - `library`: where libraries that belong to the program lie.
//! - `model`: models that are not ours. `target`: which calibration, and where.
//! - `predict`: arguments of `coordinator predict`, `decide`, `watch` and `stream`.
//! - `scale`, `validate`: arguments of `coordinator scale` and `coordinator validate`.
//! - `store`: where a store is kept, copies of it, its tokens.

mod client;
mod law;
mod library;
mod model;
mod predict;
mod scale;
mod store;
mod target;
mod validate;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use tracing_subscriber::filter::{LevelFilter, Targets};

use crate::embedded::WorkerConfig;
use crate::schema::FileKind;

pub use client::ClientArguments;
pub use law::{AddLawArguments, LibraryCommand};
pub use library::beside_program;
pub use model::ModelArguments;
pub use predict::{DecideArguments, PredictArguments, PredictionFormat, StreamArguments, WatchArguments};
pub use scale::{EngineKind, ScaleArguments};
pub use store::{BackupArguments, CopyStoreArguments, StoreArguments, TokenCommand};
pub use target::{SourceArguments, TargetArguments};
pub use validate::{LeaveOut, ValidateArguments, ValidationFormat};

/// The processors that this program was built for.
pub const ARCHITECTURE: &str = std::env::consts::ARCH;

/// Finds the physics that a wheel-soil model is missing.
#[derive(Debug, Parser)]
#[command(version, name = "coordinator")]
pub struct CoordinatorConfig {
    /// The command to execute.
    #[command(subcommand)]
    pub command: CoordinatorCommand,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum CoordinatorCommand {
    /// Calibrate in one process with local workers; results go to a folder. Run again to resume.
    Run(RunArguments),
    /// Validate a job and estimate its cost.
    Check(CheckArguments),
    /// Convert a table of measurements (text, .xlsx, .ods, .xls, .mat) to runs.csv by a map, or propose the map.
    Import(ImportArguments),
    /// Run the service: REST interface and endpoint for workers.
    Serve(ServeArguments),
    /// Submit a job to a service.
    Submit(SubmitArguments),
    /// List calibrations.
    List(ListArguments),
    /// Show the status of a calibration.
    Status(TargetArguments),
    /// Cancel a calibration; it cannot be resumed.
    Cancel(TargetArguments),
    /// Pause a calibration: no further evaluations are leased.
    Pause(TargetArguments),
    /// Resume a paused calibration.
    Resume(ResumeArguments),
    /// Compare model and measurement, run by run.
    Compare(TargetArguments),
    /// Write the report of a calibration.
    Report(ReportArguments),
    /// Write a calibration for other programs: csv, json, arrow, parquet, zarr, netcdf, table, fmu, chrono.
    Export(ExportArguments),
    /// Show how reliable a calibration is and where its model fails.
    Diagnose(TargetArguments),
    /// Leave each level of a factor out in turn, and predict it by a calibration on the rest.
    Validate(ValidateArguments),
    /// Predict conditions of your own: channels, traction, slopes, energy, probabilities of statements.
    Predict(PredictArguments),
    /// Compare options by their expected losses, and say what one more run is worth.
    Decide(DecideArguments),
    /// Follow a campaign: after each run of a file, the posterior, what is missing, and the run to make next.
    Watch(WatchArguments),
    /// Follow a recording from standard input: the parameters of the soil after each second, and changes of the soil.
    Stream(StreamArguments),
    /// Search for an effect that the model of a calibration is missing.
    Discover(DiscoverArguments),
    /// Extend a study by a calibration with one additional effect.
    Extend(ExtendArguments),
    /// Add measurements to a study and calibrate with all of them.
    AddRuns(AddRunsArguments),
    /// List the effects of the catalogue, or show one: its file and its influence on the measured quantities.
    Effects(EffectsArguments),
    /// Add, list and remove laws that every later search of a service tries.
    #[command(subcommand)]
    Library(LibraryCommand),
    /// Take a study out of the lists of a service; its results stay.
    Archive(StudyArguments),
    /// Take an archived study back into the lists.
    Restore(StudyArguments),
    /// Delete a study of a service, with its calibrations and results, for good.
    Delete(StudyArguments),
    /// Start and end workers on machines of Slurm, HyperQueue or Kubernetes, by the work that a service has.
    Scale(ScaleArguments),
    /// Copy a store, also one that a service is using, to a new file.
    Backup(BackupArguments),
    /// Copy a store from an SQLite file to a PostgreSQL server, or from a server to a file.
    CopyStore(CopyStoreArguments),
    /// Check this machine, its store and a service, and say what to do where something is amiss.
    Doctor(DoctorArguments),
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
    /// Print the JSON schema of a kind of file, or write all of them with the settings of Taplo, for editors.
    Schema(SchemaArguments),
    /// Add, list and revoke the tokens that a service asks for.
    #[command(subcommand)]
    Token(TokenCommand),
    /// Do what the program `worker` does: serve a coordinator, or simulate.
    #[command(display_name = "worker", args_conflicts_with_subcommands = true)]
    Worker(WorkerConfig),
}

/// A job file and additional effects.
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
    /// Accepts what looks odd as meant, by the name that the question has; may be repeated.
    #[arg(long, value_name = "NAME")]
    pub accept: Vec<String>,
}

/// Convert a table of measurements to runs.csv, or propose the map for it.
#[derive(Debug, Args)]
pub struct ImportArguments {
    /// The table: text with any separator, a spreadsheet, a MATLAB file, or a ROS bag; recordings may be several files, or folders of them.
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// Where each column of runs.csv comes from.
    #[arg(
        long,
        value_name = "MAP",
        requires = "output",
        required_unless_present = "guess"
    )]
    pub map: Option<PathBuf>,
    /// The file of runs that is written; notes and histories go beside it.
    #[arg(long, value_name = "RUNS", requires = "map")]
    pub output: Option<PathBuf>,
    /// Prints a proposed map; what the file does not state is marked with "?".
    #[arg(long, conflicts_with_all = ["map", "output"])]
    pub guess: bool,
    /// The sheet to propose a map for, or the struct of a MATLAB file; by default, the largest one.
    #[arg(long, value_name = "NAME", requires = "guess")]
    pub sheet: Option<String>,
}

/// Print the JSON schema of a kind of file, or write all of them.
#[derive(Debug, Args)]
pub struct SchemaArguments {
    /// The kind of file.
    #[arg(value_name = "KIND", required_unless_present = "output")]
    pub kind: Option<FileKind>,
    /// Writes the schemas of all kinds into this folder, and .taplo.toml, which says what files have them.
    #[arg(long, value_name = "FOLDER", conflicts_with = "kind")]
    pub output: Option<PathBuf>,
}

/// List the effects of the catalogue, or show one.
#[derive(Debug, Args)]
pub struct EffectsArguments {
    /// An effect of the catalogue; by default, all of them are listed.
    #[arg(conflicts_with = "file")]
    pub name: Option<String>,
    /// Shows the effect of this file instead.
    #[arg(long)]
    pub file: Option<PathBuf>,
    /// The model in which its influence is shown.
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

/// Validate a job and estimate its cost.
#[derive(Debug, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub file: JobArguments,
    #[command(flatten)]
    pub models: ModelArguments,
}

/// Calibrate in one process.
#[derive(Debug, Args)]
pub struct RunArguments {
    #[command(flatten)]
    pub file: JobArguments,
    /// Folder of the results and the store; by default out/NAME, named after the job file or its folder.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Number of simulation threads in this process; by default, one per core.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS")]
    pub local_workers: Option<usize>,
    #[command(flatten)]
    pub models: ModelArguments,
    /// Prints tables, flags and explanations too.
    #[arg(long)]
    pub verbose: bool,
    /// Address at which remote workers may join.
    #[arg(long, value_name = "ADDR")]
    pub listen: Option<std::net::SocketAddr>,
    #[command(flatten)]
    pub exposure: ExposureArguments,
}

/// Who may use a listening address.
#[derive(Debug, Args)]
pub struct ExposureArguments {
    /// Accepts requests to this host name too, as of a reverse proxy; may be repeated, or several between commas.
    #[arg(long, value_name = "NAME", env = "GROUSER_HOST", value_delimiter = ',')]
    pub host: Vec<String>,
    /// Speaks TLS with this certificate, a PEM file with those of its authorities behind it; by default, plain HTTP.
    #[arg(
        long,
        value_name = "PEM",
        env = "GROUSER_TLS_CERTIFICATE",
        requires = "tls_key"
    )]
    pub tls_certificate: Option<PathBuf>,
    /// The private key of the certificate.
    #[arg(
        long,
        value_name = "PEM",
        env = "GROUSER_TLS_KEY",
        requires = "tls_certificate"
    )]
    pub tls_key: Option<PathBuf>,
    /// Asks nobody for a token: whoever reaches the address may read everything, submit, cancel, and answer as a worker.
    #[arg(long)]
    pub insecure: bool,
}

/// Run the service.
#[derive(Debug, Args)]
pub struct ServeArguments {
    /// Address to listen on.
    #[arg(long, env = "GROUSER_LISTEN", default_value = "127.0.0.1:7070")]
    pub listen: std::net::SocketAddr,
    #[command(flatten)]
    pub store: StoreArguments,
    /// Number of simulation threads in this process.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS", default_value_t = 0)]
    pub local_workers: usize,
    #[command(flatten)]
    pub models: ModelArguments,
    /// Duration of a lease without renewal `[ms]`.
    #[arg(long, env = "GROUSER_LEASE_MS", default_value_t = crate::service::LEASE_MS)]
    pub lease_ms: u64,
    /// Lets a second worker compute this share of the evaluations, and the first results of every new worker, and compares the
    /// answers; 0 compares nothing `[%]`.
    #[arg(long, env = "GROUSER_VERIFY_PERCENT", value_name = "PERCENT", default_value_t = crate::service::VERIFIED_PERCENT)]
    pub verify_percent: f64,
    /// Counts all workers of a token as one in these comparisons, and quarantines them together: whoever has one token has one vote.
    #[arg(long, env = "GROUSER_ONE_VOTE_PER_TOKEN")]
    pub one_vote_per_token: bool,
    /// Takes the answers of the workers of this token for right where answers differ; may be repeated, or several between commas.
    #[arg(long, value_name = "TOKEN", env = "GROUSER_TRUST", value_delimiter = ',')]
    pub trust: Vec<String>,
    /// Shows what the store holds and changes nothing: takes no jobs and no results, and starts no threads. Works beside a
    /// service that uses the store, and where nothing can be written.
    #[arg(long)]
    pub read_only: bool,
    /// Waits while another coordinator holds the store, and takes over as soon as that coordinator ends for any reason; until then it
    /// does not listen.
    #[arg(long, env = "GROUSER_STANDBY", conflicts_with = "read_only")]
    pub standby: bool,
    /// Posts web hooks of jobs to this host; may be repeated, or several between commas. By default, to none.
    #[arg(
        long,
        value_name = "HOST",
        env = "GROUSER_WEBHOOK_HOST",
        value_delimiter = ','
    )]
    pub webhook_host: Vec<String>,
    /// Deletes studies this many days after they were archived; by default, archived studies are kept.
    #[arg(long, env = "GROUSER_KEEP_DAYS", value_name = "DAYS", value_parser = clap::value_parser!(u32).range(1..=36_500))]
    pub keep_days: Option<u32>,
    #[command(flatten)]
    pub exposure: ExposureArguments,
}

/// What is checked.
#[derive(Debug, Args)]
pub struct DoctorArguments {
    #[command(flatten)]
    pub store: StoreArguments,
    /// The address that `serve` would listen on.
    #[arg(long, env = "GROUSER_LISTEN", default_value = "127.0.0.1:7070")]
    pub listen: std::net::SocketAddr,
    /// A service whose answers, token and workers are checked too; by default none.
    #[arg(long, env = "GROUSER_URL")]
    pub url: Option<String>,
    #[command(flatten)]
    pub client: ClientArguments,
}

/// Submit a job to a service.
#[derive(Debug, Args)]
pub struct SubmitArguments {
    #[command(flatten)]
    pub file: JobArguments,
    /// The service posts every pause and end of the study's calibrations to this URL; its host must be one of the service's
    /// `--webhook-host`.
    #[arg(long, value_name = "URL")]
    pub webhook: Option<String>,
    /// URL of the service.
    #[arg(long, env = "GROUSER_URL", default_value = "http://127.0.0.1:7070")]
    pub url: String,
    #[command(flatten)]
    pub client: ClientArguments,
}

/// Which calibrations are listed.
#[derive(Debug, Args)]
pub struct ListArguments {
    /// Lists those of archived studies too.
    #[arg(long)]
    pub archived: bool,
    /// Lists this many at most, the oldest first.
    #[arg(long, value_name = "N")]
    pub limit: Option<usize>,
    /// Lists those with higher numbers than this one, as of the last line of an earlier list.
    #[arg(long, value_name = "ID")]
    pub after: Option<i64>,
    #[command(flatten)]
    pub source: SourceArguments,
}

/// One study of a service.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// Number of the study.
    pub study: i64,
    /// URL of the service.
    #[arg(long, env = "GROUSER_URL", default_value = "http://127.0.0.1:7070")]
    pub url: String,
    #[command(flatten)]
    pub client: ClientArguments,
}

/// Resume a paused calibration.
#[derive(Debug, Args)]
pub struct ResumeArguments {
    #[command(flatten)]
    pub target: TargetArguments,
    /// Count evaluations that used up their attempts as rejected; else they are tried again.
    #[arg(long, conflicts_with = "version")]
    pub skip_faults: bool,
    /// Go on with workers of this version of the equations alone; results of another version are dropped.
    #[arg(long, value_name = "VERSION")]
    pub version: Option<String>,
}

/// Write the report of a calibration.
#[derive(Debug, Args)]
pub struct ReportArguments {
    #[command(flatten)]
    pub target: TargetArguments,
    /// Output file; by default, standard output.
    #[arg(long)]
    pub output: Option<PathBuf>,
}

/// Write a calibration for other programs.
#[derive(Debug, Args)]
pub struct ExportArguments {
    #[command(flatten)]
    pub target: TargetArguments,
    /// Format of the exported file.
    #[arg(long, value_enum, default_value_t = ExportFormat::Csv)]
    pub format: ExportFormat,
    /// Output file, of zarr and chrono a new folder; by default, standard output for csv and json.
    #[arg(long)]
    pub output: Option<PathBuf>,
    /// Of a table, the values of one quantity of its grid; repeat it for each quantity.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT")]
    pub grid: Vec<String>,
    /// Of table, fmu and chrono, a quantity of the condition; by default, slip, load and speed are the medians of the
    /// fitted runs, the slip angle is 0, the pass 1, and the gravity the rig's.
    #[arg(long, value_name = "NAME=VALUE")]
    pub at: Vec<String>,
}

/// Format of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ExportFormat {
    /// Equally weighted draws, one per row.
    Csv,
    /// Summary, posterior and comparison.
    Json,
    /// The draws as an Arrow file (Feather).
    Arrow,
    /// The draws as a Parquet file.
    Parquet,
    /// Inference data for ArviZ and xarray as a folder, Zarr v3.
    Zarr,
    /// The same as one file, NetCDF 3.
    Netcdf,
    /// Predictions over a grid with intervals: a file .csv, or .npz for NumPy.
    Table,
    /// The calibrated wheel as a co-simulation unit by FMI 3.0.
    Fmu,
    /// Soil, terrain and single-wheel rig as a folder for Project Chrono.
    Chrono,
}

/// Search for an effect that the model of a calibration is missing.
#[derive(Debug, Args)]
pub struct DiscoverArguments {
    #[command(flatten)]
    pub target: TargetArguments,
    #[command(flatten)]
    pub growth: GrowthArguments,
}

/// How a folder computes an addition to its study.
#[derive(Debug, Args)]
pub struct GrowthArguments {
    /// Number of simulation threads in this process, with --out; by default, one per core.
    #[arg(long, env = "GROUSER_LOCAL_WORKERS")]
    pub local_workers: Option<usize>,
    #[command(flatten)]
    pub models: ModelArguments,
    /// Prints tables, flags and explanations too.
    #[arg(long)]
    pub verbose: bool,
}

/// Extend a study by a calibration with one additional effect.
#[derive(Debug, Args)]
pub struct ExtendArguments {
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
    /// An effect file.
    #[arg(long, value_name = "FILE")]
    pub effect_file: Option<PathBuf>,
    /// Apply the effect to this wheel only, of several.
    #[arg(long, value_name = "NAME", requires = "effect")]
    pub wheel: Option<String>,
    #[command(flatten)]
    pub growth: GrowthArguments,
}

/// Add measurements to a study.
#[derive(Debug, Args)]
pub struct AddRunsArguments {
    /// A calibration of the study.
    pub id: i64,
    /// CSV file with the columns of runs.csv.
    pub runs: PathBuf,
    #[command(flatten)]
    pub source: SourceArguments,
    #[command(flatten)]
    pub growth: GrowthArguments,
}

impl CoordinatorCommand {
    /// Returns the filter of the log: `RUST_LOG` as a level or as `target=level` between commas, else `info` with these exceptions.
    ///
    /// Warnings of slow statements are hidden, because a busy disk causes them. Only a service logs the starts, pauses and ends of
    /// calibrations, and additions to studies: the other verbs print these themselves.
    pub fn log_filter(&self) -> Targets {
        let stated = std::env::var("RUST_LOG").ok().and_then(|text| text.parse().ok());
        let (journal, of_workers) = match self {
            CoordinatorCommand::Serve(_) | CoordinatorCommand::Worker(_) => {
                (LevelFilter::INFO, LevelFilter::INFO)
            }
            _ => (LevelFilter::OFF, LevelFilter::WARN),
        };
        let additions = match self {
            CoordinatorCommand::Serve(_) | CoordinatorCommand::Run(_) => LevelFilter::INFO,
            _ => LevelFilter::WARN,
        };
        stated.unwrap_or_else(|| {
            Targets::new()
                .with_default(LevelFilter::INFO)
                .with_target("sqlx::query", LevelFilter::ERROR)
                .with_target("journal", journal)
                .with_target("worker", of_workers)
                .with_target("coordinator::http", additions)
        })
    }
}
