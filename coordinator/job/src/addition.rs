//! Additions to a job, and removals from it, as changes of its value: no text is parsed.

use std::sync::Arc;

use shared::file::FileError;
use shared::model::{ModelKind, ModelSettings};
use shared::parameters::SPATIAL;

use crate::job::Job;
use crate::model_switch::ModelSwitch;
use crate::named_files::NamedFile;
use crate::table::prior_entry::PriorEntry;

/// An addition to a job.
#[derive(Debug, Clone, Default)]
pub struct Addition {
    /// Changes of the model itself, in the order in which they are made, before everything else.
    pub changes: Vec<ModelChange>,
    /// Names of effects of the catalogue to add.
    pub effects: Vec<String>,
    /// Effect files by name.
    pub files: Vec<(String, Arc<NamedFile>)>,
    /// Lines under `[priors]`: full names of parameters, each with its number or its distribution.
    pub priors: Vec<(String, toml::Value)>,
}

/// A change of the model itself.
#[derive(Debug, Clone)]
pub enum ModelChange {
    /// A parameter gets a prior that the job holds fixed under `[model]`, under `[priors]`, or at its default.
    Free(String, toml::Value),
    /// A setting gets another value.
    Turn(&'static ModelSwitch),
}

impl Addition {
    /// Returns whether it adds nothing.
    pub fn is_empty(&self) -> bool {
        let Addition {
            changes,
            effects,
            files,
            priors,
        } = self;
        changes.is_empty() && effects.is_empty() && files.is_empty() && priors.is_empty()
    }
}

/// Returns the keys that a model loses if its kind changes: those that no other kind has.
pub(crate) fn keys_of_kinds() -> impl Iterator<Item = &'static str> {
    let keys = [ModelKind::QuasiStatic, ModelKind::Scm]
        .into_iter()
        .flat_map(ModelSettings::keys_of);
    SPATIAL.iter().map(|p| p.name).chain(keys.copied())
}

impl Job {
    /// Returns the job with an addition.
    ///
    /// # Errors
    /// [`FileError`]: a line of `[priors]` or a file exists already, or the model is not valid with it.
    pub fn with(&self, name: &str, addition: &Addition) -> Result<Job, FileError> {
        let fail = |message: String| FileError::whole(name, message);
        let mut job = self.clone();
        for change in &addition.changes {
            match change {
                ModelChange::Free(parameter, prior) => {
                    job.release(parameter);
                    job.add_prior(parameter, prior).map_err(fail)?;
                }
                ModelChange::Turn(switch) => job.turn(switch),
            }
        }
        for (file, text) in &addition.files {
            // A candidate's file is there before the model has its effect.
            let is_candidate = job.candidate_files.contains(file)
                && job.files.text(file).is_some_and(|there| there == text.text);
            if !is_candidate && !job.files.insert(file, Arc::clone(text)) {
                return Err(fail(format!("file \"{file}\" exists already")));
            }
        }
        job.list("effects", addition.effects.iter());
        job.list("effect_files", addition.files.iter().map(|(file, _)| file));
        for (parameter, prior) in &addition.priors {
            job.add_prior(parameter, prior).map_err(fail)?;
        }
        job.read_model().map_err(fail)?;
        Ok(job)
    }

    /// Returns the job without some of its effects: their names, their files and every line about their parameters are removed.
    ///
    /// # Errors
    /// [`FileError`] if the model is not valid without them.
    pub fn without(&self, name: &str, effects: &[String]) -> Result<Job, FileError> {
        let mut job = self.clone();
        let is_named = |effect: &str| effects.iter().any(|dropped| dropped == effect);
        let is_dropped = |file: &str| {
            let effect = self.files.effect(file);
            effect.is_some_and(|effect| effect.is_ok_and(|effect| is_named(&effect.name)))
        };
        job.unlist("effects", is_named);
        job.unlist("effect_files", is_dropped);
        // A dotted key without quotes is a table under the effect's name.
        let is_about = |key: &str| is_named(key.split_once('.').map_or(key, |(effect, _)| effect));
        job.table.retain(|key, _| !is_about(key));
        job.priors.retain(|entry| !is_about(&entry.name));
        job.files.retain(|file| {
            self.candidate_files.iter().any(|candidate| candidate == file) || !is_dropped(file)
        });
        job.read_model()
            .map_err(|message| FileError::whole(name, message))?;
        Ok(job)
    }

    /// Removes the number at which the job holds a parameter.
    fn release(&mut self, parameter: &str) {
        let is_number = |value: &toml::Value| value.is_float() || value.is_integer();
        if self.table.get(parameter).is_some_and(is_number) {
            self.table.remove(parameter);
        }
        self.priors
            .retain(|entry| entry.name != parameter || !is_number(&entry.value));
    }

    /// Gives a setting of the model another value.
    fn turn(&mut self, switch: &ModelSwitch) {
        if switch.is_kind() {
            for key in keys_of_kinds() {
                self.table.remove(key);
            }
        }
        self.release(switch.key);
        self.table.insert(switch.key.to_owned(), switch.value.into());
    }

    /// Adds names to a list under `[model]`.
    pub(crate) fn list<'a>(&mut self, key: &str, names: impl Iterator<Item = &'a String>) {
        let names: Vec<toml::Value> = names.map(|name| name.as_str().into()).collect();
        if !names.is_empty() {
            let list = self
                .table
                .entry(key)
                .or_insert_with(|| toml::Value::Array(Vec::new()));
            list.as_array_mut()
                .expect("the model was read from this table")
                .extend(names);
        }
    }

    /// Removes names from a list under `[model]`.
    fn unlist(&mut self, key: &str, condition: impl Fn(&str) -> bool) {
        if let Some(list) = self.table.get_mut(key).and_then(toml::Value::as_array_mut) {
            list.retain(|name| !name.as_str().is_some_and(&condition));
        }
    }

    /// Adds a line under `[priors]`, before the entries that are tables with headers, as TOML requires.
    fn add_prior(&mut self, parameter: &str, prior: &toml::Value) -> Result<(), String> {
        if self.priors.iter().any(|entry| entry.name == parameter) {
            return Err(format!("{parameter} is already under [priors]"));
        }
        let end = self.priors.iter().position(|entry| entry.has_header);
        let entry = PriorEntry {
            name: parameter.to_owned(),
            line: None,
            has_header: false,
            value: prior.clone(),
        };
        self.priors.insert(end.unwrap_or(self.priors.len()), entry);
        Ok(())
    }
}
