//! Settings of `coordinator predict`, `decide`, `watch` and `stream`.

use std::path::PathBuf;

use clap::Args;

use super::target::{SourceArguments, TargetArguments};

/// Predict conditions of your own.
#[derive(Debug, Args)]
pub struct PredictArguments {
    #[command(flatten)]
    pub target: TargetArguments,
    /// CSV file with a row for each condition: `run`, `wheel`, `slip`, `wheel_load_n`, `sled_speed_m_s`, `slip_angle_deg`, `pass`,
    /// `gravity_m_s2`, `slope_deg`. What a row leaves out follows from the fitted runs.
    #[arg(long, value_name = "FILE", required_unless_present_any = ["sweep", "at"])]
    pub plan: Option<PathBuf>,
    /// A value of a column of the plan, in place of a file; may be repeated.
    #[arg(long, value_name = "NAME=VALUE", conflicts_with = "plan")]
    pub at: Vec<String>,
    /// Takes one quantity in evenly spaced values for every row, as in `slip=0:0.8:41`.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT")]
    pub sweep: Option<String>,
    /// TOML file with tables `[wheel.NAME]` of wheels that the experiment does not have.
    #[arg(long, value_name = "FILE")]
    pub wheels: Option<PathBuf>,
    /// Asks for the probability of a statement, as in `drawbar_pull_n > 12`; may be repeated.
    #[arg(long, value_name = "STATEMENT")]
    pub probability: Vec<String>,
    /// Number of draws of each model; by default, up to 199, and fewer for a slow model.
    #[arg(long, value_name = "COUNT")]
    pub draws: Option<usize>,
    /// What is printed.
    #[arg(long, value_enum, default_value_t = PredictionFormat::Text)]
    pub format: PredictionFormat,
}

/// Compare options by their expected losses.
#[derive(Debug, Args)]
pub struct DecideArguments {
    /// A file with a table `[decision]`, alone or in a job.
    pub file: PathBuf,
    /// Id of the calibration; by default, the current model of the only study.
    pub id: Option<i64>,
    #[command(flatten)]
    pub source: SourceArguments,
    /// Number of draws of each model; by default, up to 199, and fewer for a slow model.
    #[arg(long, value_name = "COUNT")]
    pub draws: Option<usize>,
    /// What is printed.
    #[arg(long, value_enum, default_value_t = PredictionFormat::Text)]
    pub format: PredictionFormat,
    /// Writes the report of the study with this decision to a file, too.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
}

/// Follow the runs of a file or of the files of a folder.
#[derive(Debug, Args)]
pub struct WatchArguments {
    /// CSV file with the columns of `runs.csv`, to which rows are appended; or a folder into which such files are dropped, and recordings or
    /// other tables with `--map`. Rows of the file for runs that the calibration has already are passed over.
    pub runs: PathBuf,
    /// Id of the calibration; by default, the current model of the only study.
    pub id: Option<i64>,
    #[command(flatten)]
    pub source: SourceArguments,
    /// TOML file that says what the columns of a recording or a table in the folder are, as `import` reads it.
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Largest number of evaluations of the search for what is missing after each run; by default, 100,000 of a model in steady motion and
    /// 2,000 of any other.
    #[arg(long, value_name = "COUNT")]
    pub max_evaluations: Option<usize>,
    /// Ends after the rows that the file has now.
    #[arg(long)]
    pub once: bool,
}

/// Follow a recording from standard input.
#[derive(Debug, Args)]
pub struct StreamArguments {
    #[command(flatten)]
    pub target: TargetArguments,
    /// A parameter that may vary; may be repeated. By default, all of the soil.
    #[arg(long, value_name = "NAME")]
    pub parameter: Vec<String>,
    /// Wheel, if the fitted runs have several.
    #[arg(long, value_name = "NAME")]
    pub wheel: Option<String>,
    /// What is printed: a line for each second as text or JSON, or a row for each second and parameter.
    #[arg(long, value_enum, default_value_t = PredictionFormat::Text)]
    pub format: PredictionFormat,
}

/// Form in which predictions, decisions and recordings are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum PredictionFormat {
    /// Tables and sentences.
    Text,
    /// All numbers as JSON.
    Json,
    /// A row for each run and quantity, or for each time and parameter; not of decisions.
    Csv,
}
