//! Arguments of the verbs on a whole store.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Subcommand};
use record::TokenRole;

/// The store of a service.
#[derive(Debug, Args)]
pub struct StoreArguments {
    /// The store: an SQLite file, or a database of a PostgreSQL server.
    #[arg(
        long,
        env = "GROUSER_STORE",
        hide_env_values = true,
        default_value = "sqlite://grouser.db",
        value_name = "sqlite://FILE|postgres://URL"
    )]
    pub store: String,
}

/// Copy a store.
#[derive(Debug, Args)]
pub struct BackupArguments {
    /// The new file.
    pub file: PathBuf,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Copy a store between a file and a server.
#[derive(Debug, Args)]
pub struct CopyStoreArguments {
    /// What is copied, as it is at one moment: stop its service first, or what that stores afterwards is missing.
    #[arg(value_name = "sqlite://FILE|postgres://URL")]
    pub from: String,
    /// Where it is copied to: a new file, or a database without tables.
    #[arg(value_name = "postgres://URL|sqlite://FILE")]
    pub to: String,
}

/// Add, list and revoke tokens; a running service follows within a second.
#[derive(Debug, Subcommand)]
pub enum TokenCommand {
    /// Add a token and print it; it is shown this once.
    Add {
        /// Name of its holder.
        name: String,
        /// What its holder may do: read; read, submit and control; or work as a worker.
        #[arg(long, value_parser = role_parser())]
        role: TokenRole,
        /// Takes the token of this file, as of a secret of Kubernetes, and prints nothing; where it is there already, nothing changes.
        #[arg(long, value_name = "FILE")]
        from: Option<PathBuf>,
        #[command(flatten)]
        store: StoreArguments,
    },
    /// List the tokens: name, role, whether it is accepted.
    List(StoreArguments),
    /// Revoke the token of a name; a store that has had a token keeps asking for one.
    Revoke {
        /// Name of its holder.
        name: String,
        #[command(flatten)]
        store: StoreArguments,
    },
}

fn role_parser() -> impl TypedValueParser<Value = TokenRole> {
    PossibleValuesParser::new(TokenRole::ALL.map(TokenRole::name))
        .map(|name| TokenRole::from_name(&name).expect("the parser accepts names of roles alone"))
}
