//! A job with effects that users have added to a service's catalogue: they become effect files of the job.

use std::collections::BTreeSet;

use formula::catalogue::find;
use serde::Deserialize;
use shared::file::{FileError, FileSet, parse_toml};

use super::discovery_job::{keep, table};
use super::extended_job::extended_job;
use super::point_job::edited;

/// An effect of a service's catalogue, as a job names it and as a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnEffect {
    /// How the job names it: `NAME`, or `NAME@VERSION`.
    pub named: String,
    /// The name of its file, which states the version.
    pub file: String,
    /// Its file.
    pub text: String,
}

impl OwnEffect {
    /// A version of an effect, as a job names it.
    pub fn new(named: String, name: &str, version: i64, text: String) -> OwnEffect {
        let file = format!("{name}@{version}.toml");
        OwnEffect { named, file, text }
    }
}

#[derive(Default, Deserialize)]
struct Listed {
    #[serde(default)]
    model: ListedModel,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct ListedModel {
    effects: Vec<String>,
}

/// The effects that a job lists and the program's catalogue lacks. A text that is no job lists none: what is wrong with it is
/// said where it is read.
pub fn foreign_effects(toml: &str) -> BTreeSet<String> {
    let listed: Listed = parse_toml("job.toml", toml).unwrap_or_default();
    let listed = listed.model.effects.into_iter();
    listed.filter(|name| find(name).is_none()).collect()
}

/// The text of a job that does not list effects of a service's catalogue; a line that is wrong keeps its number.
///
/// # Errors
/// [`FileError`] where the text is no TOML.
pub fn without_own_effects(name: &str, toml: &str, own: &[OwnEffect]) -> Result<String, FileError> {
    if own.is_empty() {
        return Ok(toml.to_owned());
    }
    edited(name, toml, |document| {
        if let Some(model) = table(document, "model") {
            keep(model, "effects", |effect| {
                own.iter().all(|own| own.named != effect)
            });
        }
        Ok(())
    })
}

/// The job with effects of a service's catalogue as files of its own, so that no later version changes what it means.
///
/// # Errors
/// [`FileError`] where the job has another file of that name.
pub fn with_own_effects(name: &str, job: FileSet, own: &[OwnEffect]) -> Result<FileSet, FileError> {
    let mut files = job.files;
    for effect in own {
        if files.insert(effect.file.clone(), effect.text.clone()).is_some() {
            let message = format!("file \"{}\" exists already", effect.file);
            return Err(FileError::whole(name, message));
        }
    }
    let toml = without_own_effects(name, &job.toml, own)?;
    let names: Vec<String> = own.iter().map(|own| own.file.clone()).collect();
    let toml = extended_job(name, &toml, &[], &names, &[])?;
    Ok(FileSet { toml, files })
}

#[cfg(test)]
mod tests {
    use super::*;

    const JOB: &str = "[model]\nkind = \"scm\"\neffects = [\"mine@2\", \"adhesion\", \"yours\"] # why\n";

    fn own(named: &str, name: &str, version: i64) -> OwnEffect {
        OwnEffect::new(named.to_owned(), name, version, format!("text of {name}"))
    }

    #[test]
    fn effects_of_a_service_become_files_of_the_job() {
        let foreign: Vec<String> = foreign_effects(JOB).into_iter().collect();
        assert_eq!(foreign, ["mine@2", "yours"]);
        let job = FileSet {
            toml: JOB.to_owned(),
            ..FileSet::default()
        };
        let own = [own("mine@2", "mine", 2), own("yours", "yours", 7)];
        let with = with_own_effects("job.toml", job.clone(), &own).unwrap();
        let expected = "[model]\nkind = \"scm\"\neffects = [ \"adhesion\"] # why\neffect_files = [\"mine@2.toml\", \"yours@7.toml\"]\n";
        assert_eq!(with.toml, expected);
        assert_eq!(with.files["yours@7.toml"], "text of yours");
        let without = without_own_effects("job.toml", JOB, &own).unwrap();
        assert_eq!(without.lines().count(), JOB.lines().count());
        assert_eq!(with_own_effects("job.toml", job, &[]).unwrap().toml, JOB);
        let again = with_own_effects("job.toml", with, &own[..1]).unwrap_err();
        assert_eq!(again.to_string(), "job.toml: file \"mine@2.toml\" exists already");
    }

    #[test]
    fn what_is_no_job_lists_nothing() {
        for text in ["", "[model", "[model]\neffects = 3\n", "model = 1\n"] {
            assert!(foreign_effects(text).is_empty(), "{text}");
        }
    }
}
