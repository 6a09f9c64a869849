//! Effects that users have added to a service's catalogue: they become effect files of a job.

use std::sync::Arc;

use crate::named_files::NamedFile;

/// An effect of a service's catalogue, as a job lists it and as a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ServiceEffect {
    /// How the job lists it: `NAME`, or `NAME@VERSION`.
    pub listed_as: String,
    /// The name of its file, which states the version.
    pub file: String,
    /// Its file.
    pub text: String,
}

impl ServiceEffect {
    /// A version of an effect, as a job lists it.
    pub fn new(listed_as: String, name: &str, version: i64, text: String) -> ServiceEffect {
        ServiceEffect {
            listed_as,
            file: format!("{name}@{version}.toml"),
            text,
        }
    }

    /// Its file by name.
    pub(crate) fn named_file(&self) -> (String, Arc<NamedFile>) {
        (self.file.clone(), NamedFile::new(self.text.clone()))
    }
}
