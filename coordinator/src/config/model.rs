//! The models that are not ours that a process runs.

use clap::Args;

/// The models that are not ours that this process runs.
#[derive(Debug, Args)]
pub struct ModelArguments {
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
