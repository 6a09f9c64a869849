//! Arguments of a client of a service.

use std::path::PathBuf;

use clap::Args;
use shared::bearer::{BearerToken, BearerTokenError};

/// Arguments of a client: a token, and trust in a certificate. In the environment, `GROUSER_TOKEN` has the token itself.
#[derive(Debug, Args)]
pub struct ClientArguments {
    /// File with the token that the service asks for; by default, `GROUSER_TOKEN` from the environment.
    #[arg(long, value_name = "FILE")]
    pub token_file: Option<PathBuf>,
    /// Trusts a service at an https URL by this certificate of its authority, a PEM file, in place of those of this machine.
    #[arg(long, value_name = "PEM", env = "GROUSER_CA_CERTIFICATE")]
    pub ca_certificate: Option<PathBuf>,
}

impl ClientArguments {
    /// Returns the token: of the file, or else of the environment.
    ///
    /// # Errors
    /// The file cannot be read, or the token has no form.
    pub fn token(&self) -> Result<Option<BearerToken>, BearerTokenError> {
        BearerToken::find(self.token_file.as_deref(), std::env::var("GROUSER_TOKEN").ok())
    }
}
