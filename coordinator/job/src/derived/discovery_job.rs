//! The jobs with which a study goes on: with a search for missing effects, without some effects.

use std::collections::BTreeMap;

use shared::file::{FileError, FileSet};
use shared::model::ModelKind;
use toml_edit::{DocumentMut, Item, TableLike};

use super::one_model::keep_model;
use super::point_job::{edited, keep_candidates};

/// A job whose study searches for a missing effect: one that does not ask for it is given `[discovery] apply = "ask"`.
///
/// # Errors
/// [`FileError`] where the text is no job.
pub fn searched_job(name: &str, job: &FileSet) -> Result<FileSet, FileError> {
    let toml = edited(name, &job.toml, |document| {
        let discovery = document.entry("discovery").or_insert(toml_edit::table());
        let discovery = discovery
            .as_table_like_mut()
            .ok_or("[discovery] is not a table")?;
        if discovery
            .get("apply")
            .is_none_or(|apply| apply.as_str() == Some("off"))
        {
            discovery.insert("apply", toml_edit::value("ask"));
        }
        Ok(())
    })?;
    Ok(FileSet {
        toml,
        files: job.files.clone(),
    })
}

/// The model of a job, of several the first; `None` where this version does not know it. Reads nothing else: lists ask this of every job.
pub fn model_kind(toml: &str) -> Option<ModelKind> {
    let job: toml::Table = toml.parse().ok()?;
    let first = || job.get("models")?.as_array()?.first();
    let model = job.get("model").or_else(first)?;
    model.get("kind")?.clone().try_into().ok()
}

/// A job as its study goes on with it: it asks for no point estimates and no search of its own.
///
/// # Errors
/// [`FileError`] where the text is no job.
pub fn continued_job(name: &str, job: &FileSet) -> Result<FileSet, FileError> {
    let toml = edited(name, &job.toml, |document| {
        keep_model(document, 0)?;
        if let Some(sampler) = table(document, "sampler") {
            sampler.remove("point_estimates");
        }
        keep_candidates(document);
        Ok(())
    })?;
    Ok(FileSet {
        toml,
        files: job.files.clone(),
    })
}

/// A job without some of its effects: their names, their files and every line about their parameters go.
///
/// # Errors
/// [`FileError`] where the text is no job.
pub fn without_effects(name: &str, job: &FileSet, effects: &[String]) -> Result<FileSet, FileError> {
    let is_dropped = |file: &str| {
        let effect = job.files.get(file).and_then(|text| effect_name(text));
        effect.is_some_and(|effect| effects.contains(&effect))
    };
    let toml = edited(name, &job.toml, |document| {
        keep_model(document, 0)?;
        let of_dropped = |key: &str| {
            key.split_once('.')
                .is_some_and(|(effect, _)| effects.iter().any(|e| e == effect))
        };
        if let Some(model) = table(document, "model") {
            keep(model, "effects", |effect| !effects.iter().any(|e| e == effect));
            keep(model, "effect_files", |file| !is_dropped(file));
        }
        for part in ["model", "priors"] {
            if let Some(table) = table(document, part) {
                let keys: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).collect();
                // A dotted key without quotes is a table under the effect's name.
                for key in keys.iter().filter(|key| of_dropped(key) || effects.contains(key)) {
                    table.remove(key);
                }
            }
        }
        Ok(())
    })?;
    let files: BTreeMap<String, String> = job
        .files
        .iter()
        .filter(|(file, _)| !is_dropped(file))
        .map(|(file, text)| (file.clone(), text.clone()))
        .collect();
    Ok(FileSet { toml, files })
}

/// The name that an effect file gives its effect.
pub fn effect_name(text: &str) -> Option<String> {
    let file: toml::Table = text.parse().ok()?;
    Some(file.get("name")?.as_str()?.to_owned())
}

pub(super) fn table<'a>(document: &'a mut DocumentMut, name: &str) -> Option<&'a mut dyn TableLike> {
    document.get_mut(name).and_then(Item::as_table_like_mut)
}

/// Keeps the words of a list that satisfy a condition.
pub(super) fn keep(table: &mut dyn TableLike, list: &str, condition: impl Fn(&str) -> bool) {
    if let Some(words) = table.get_mut(list).and_then(Item::as_array_mut) {
        words.retain(|word| word.as_str().is_none_or(&condition));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::JobFile;

    const JOB: &str = r#"# why
[model]
kind = "scm" # here
effects = ["hard_pan", "slip_sinkage"]
effect_files = ["mine.toml", "yours.toml"]
[priors]
n = 1.1
"slip_sinkage.exponent_slope" = { uniform = [0.0, 1.0] }
"mine.a.front" = 0.5
[sampler]
particles = 50
seed = 7
point_estimates = ["ga"]
[discovery]
apply = "auto"
"#;

    fn job() -> FileSet {
        let file = |name: &str| format!("name = \"{name}\"\nshear = \"tau\"\n");
        FileSet {
            toml: JOB.into(),
            files: [("mine.toml", "mine"), ("yours.toml", "yours")]
                .map(|(file_name, effect)| (file_name.to_owned(), file(effect)))
                .into(),
        }
    }

    #[test]
    fn what_goes_on_asks_for_nothing_beside_itself() {
        let continued = continued_job("job.toml", &job()).unwrap();
        let parsed = JobFile::parse("job.toml", &continued.toml).unwrap();
        assert!(parsed.point_estimates.is_empty());
        assert_eq!(
            parsed.discovery,
            JobFile::parse("job.toml", "[model]\nkind = \"scm\"\n")
                .unwrap()
                .discovery
        );
        assert!(
            continued.toml.contains("particles = 50\nseed = 7\n"),
            "{}",
            continued.toml
        );
    }

    #[test]
    fn a_dropped_effect_leaves_no_line_behind() {
        let names = ["slip_sinkage", "mine"].map(String::from);
        let without = without_effects("job.toml", &job(), &names).unwrap();
        for name in names {
            assert!(!without.toml.contains(&name), "{}", without.toml);
        }
        let parsed = JobFile::parse("job.toml", &without.toml).unwrap();
        assert_eq!(parsed.model.effects, ["hard_pan"]);
        assert_eq!(parsed.named_files(), ["yours.toml"]);
        assert_eq!(without.files.keys().collect::<Vec<_>>(), ["yours.toml"]);
        assert!(
            without
                .toml
                .starts_with("# why\n[model]\nkind = \"scm\" # here\n")
        );
    }
}
