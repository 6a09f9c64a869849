//! The files that a job names beside its experiment.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use formula::Effect;
use shared::file::FileError;
use shared::model::effects::read_user_effect;

/// The files that a job names, by name. Copies share the texts, and an effect file is parsed once.
#[derive(Debug, Clone, Default)]
pub struct NamedFiles(BTreeMap<String, Arc<NamedFile>>);

/// A file with its text.
#[derive(Debug)]
pub struct NamedFile {
    /// The text.
    pub text: String,
    effect: OnceLock<Result<Effect, FileError>>,
}

impl NamedFile {
    /// Returns a file with this text.
    pub fn new(text: String) -> Arc<NamedFile> {
        let effect = OnceLock::new();
        Arc::new(NamedFile { text, effect })
    }
}

impl NamedFiles {
    /// Returns a file, if it is in the set.
    pub fn get(&self, name: &str) -> Option<&Arc<NamedFile>> {
        self.0.get(name)
    }

    /// Returns the text of a file, if it is in the set.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.get(name).map(|file| file.text.as_str())
    }

    /// Returns the effect in a file; `None` if there is no such file.
    pub fn effect(&self, name: &str) -> Option<Result<Effect, FileError>> {
        let file = self.get(name)?;
        Some(
            file.effect
                .get_or_init(|| read_user_effect(name, &file.text))
                .clone(),
        )
    }

    /// Adds a file; returns whether its name was free.
    pub fn insert(&mut self, name: &str, file: Arc<NamedFile>) -> bool {
        self.0.insert(name.to_owned(), file).is_none()
    }

    /// Keeps the files whose names satisfy a condition.
    pub(crate) fn retain(&mut self, condition: impl Fn(&str) -> bool) {
        self.0.retain(|name, _| condition(name));
    }
}

impl From<&BTreeMap<String, String>> for NamedFiles {
    fn from(texts: &BTreeMap<String, String>) -> Self {
        let file = |(name, text): (&String, &String)| (name.clone(), NamedFile::new(text.clone()));
        NamedFiles(texts.iter().map(file).collect())
    }
}
