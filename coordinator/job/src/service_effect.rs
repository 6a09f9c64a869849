//! Effects that users have added to a service's catalogue: they become effect files of a job.

use std::sync::Arc;

use shared::file::FileError;
use toml_edit::{DocumentMut, TomlError, value};

use crate::named_files::NamedFile;

/// An effect of a service's catalogue, as a job lists it and as a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ServiceEffect {
    /// Entry in the job's list: `NAME`, or `NAME@VERSION`.
    pub listed_as: String,
    /// Name of the file, which states the version.
    pub file: String,
    /// Text of the file.
    pub text: String,
}

impl ServiceEffect {
    /// Makes the effect file `NAME@VERSION.toml` from one stored version.
    pub fn new(listed_as: String, name: &str, version: i64, text: String) -> ServiceEffect {
        ServiceEffect {
            listed_as,
            file: format!("{name}@{version}.toml"),
            text,
        }
    }

    /// Returns the file by name.
    pub(crate) fn named_file(&self) -> (String, Arc<NamedFile>) {
        (self.file.clone(), NamedFile::new(self.text.clone()))
    }
}

/// Returns an effect file with another name or another source; everything else stays as it is written.
///
/// # Errors
/// [`FileError`] if the text is no TOML.
pub fn effect_with_origin(
    file: &str,
    text: &str,
    name: Option<&str>,
    source: Option<&str>,
) -> Result<String, FileError> {
    let document = text.parse();
    let mut document: DocumentMut = document.map_err(|e: TomlError| FileError::whole(file, e.to_string()))?;
    for (key, written) in [("name", name), ("source", source)] {
        if let Some(written) = written {
            document[key] = value(written);
        }
    }
    Ok(document.to_string())
}
