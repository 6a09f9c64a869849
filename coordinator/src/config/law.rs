//! Arguments of `coordinator library`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::target::SourceArguments;

/// Laws that every later search of a service tries.
#[derive(Debug, Subcommand)]
pub enum LibraryCommand {
    /// Add a law: an effect file, or what a search found. Every search that begins afterwards tries it.
    Add(AddLawArguments),
    /// List the laws, and in which studies each held.
    List(SourceArguments),
    /// Remove a law: later searches do not try it.
    Remove {
        /// Name of the law.
        name: String,
        #[command(flatten)]
        source: SourceArguments,
    },
}

/// Add a law to the library.
#[derive(Debug, Args)]
pub struct AddLawArguments {
    /// The effect file of the law.
    #[arg(required_unless_present = "from", conflicts_with_all = ["from", "law"])]
    pub file: Option<PathBuf>,
    /// Takes the law that the search of this calibration found.
    #[arg(long, value_name = "ID")]
    pub from: Option<i64>,
    /// One of the laws of that search, by the name of its effect; by default, the one that the search would add.
    #[arg(long, value_name = "NAME", requires = "from")]
    pub law: Option<String>,
    /// The name that the law gets.
    #[arg(long = "as", value_name = "NAME")]
    pub name: Option<String>,
    #[command(flatten)]
    pub source: SourceArguments,
}
