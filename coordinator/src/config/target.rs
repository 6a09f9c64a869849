//! Arguments that name a calibration and its place.

use std::path::PathBuf;

use clap::Args;

use super::client::ClientArguments;

/// The place of calibrations: a service or a folder.
#[derive(Debug, Args)]
pub struct SourceArguments {
    /// URL of a service; by default `GROUSER_URL` from the environment, or port 7070 of this machine.
    #[arg(long)]
    pub url: Option<String>,
    /// The output folder of a run.
    #[arg(long, conflicts_with_all = ["url", "token_file"])]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub client: ClientArguments,
}

impl SourceArguments {
    /// Returns the URL of the service: the argument, or else the environment's.
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
    /// Id of the calibration; may be omitted if there is only one study.
    pub id: Option<i64>,
    #[command(flatten)]
    pub source: SourceArguments,
}
