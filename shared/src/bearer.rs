//! The bearer token of a client, from a file or from the environment, never from the command line.

use std::fmt;
use std::path::Path;

use crate::file::FileError;
use crate::text_file::read_text;

/// A token; its `Debug` does not show it.
#[derive(Clone, PartialEq, Eq)]
pub struct BearerToken(String);

/// Why there is no token.
#[derive(Debug, thiserror::Error)]
pub enum BearerTokenError {
    /// The file of the token cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The token cannot be sent in a request.
    #[error("{source_name}: the token must be one line of printable ASCII characters without spaces")]
    Form {
        /// The file, or the environment variable.
        source_name: String,
    },
}

impl BearerToken {
    /// Reads the token from a file, or else from `GROUSER_TOKEN`, without the space around it. [`BearerTokenError`] names
    /// the file or the variable, never the token.
    pub fn find(
        file: Option<&Path>,
        environment: Option<String>,
    ) -> Result<Option<BearerToken>, BearerTokenError> {
        let (source_name, text) = match (file, environment) {
            (Some(file), _) => (file.display().to_string(), read_text(file)?),
            (None, Some(text)) => ("GROUSER_TOKEN".to_owned(), text),
            (None, None) => return Ok(None),
        };
        let token = text.trim();
        if token.is_empty() || !token.chars().all(|c| c.is_ascii_graphic()) {
            return Err(BearerTokenError::Form { source_name });
        }
        Ok(Some(BearerToken(token.to_owned())))
    }

    /// Returns the token itself, for a request.
    pub fn expose(&self) -> &str {
        &self.0
    }
}

impl fmt::Debug for BearerToken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("BearerToken")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_one_line_and_is_not_shown() {
        let find = |text: &str| BearerToken::find(None, Some(text.to_owned()));
        let token = find(" abc-1\n").unwrap().unwrap();
        assert_eq!(token.expose(), "abc-1");
        assert!(!format!("{token:?}").contains("abc"));
        for wrong in ["", " ", "two words", "two\nlines", "naïve"] {
            let message = find(wrong).unwrap_err().to_string();
            assert!(message.starts_with("GROUSER_TOKEN: "), "{message}");
            assert!(
                !message.contains("two") && !message.contains("naïve"),
                "{message}"
            );
        }
        assert_eq!(BearerToken::find(None, None).unwrap(), None);
    }
}
