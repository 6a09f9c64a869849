//! The job of a model with fewer effects: the same job without what is said of them.

use shared::file::{FileError, FileSet};

/// A job without some of its effects: without their names and files under `[model]`, and without the lines of their parameters.
///
/// # Arguments
/// - `effects`: names of effects; those that the job does not have change nothing.
///
/// # Errors
/// [`FileError`] where the text is no job.
pub fn reduced_job(name: &str, job: &FileSet, effects: &[&str]) -> Result<FileSet, FileError> {
    let mut document: toml_edit::DocumentMut = job
        .toml
        .parse()
        .map_err(|e: toml_edit::TomlError| FileError::whole(name, e.to_string()))?;
    let named = |text: &str| formula::Effect::read(text).ok().map(|effect| effect.name);
    let mut files = job.files.clone();
    files.retain(|_, text| !named(text).is_some_and(|own| effects.contains(&own.as_str())));
    let model = document
        .get_mut("model")
        .and_then(toml_edit::Item::as_table_like_mut);
    if let Some(model) = model {
        for (key, is_kept) in [
            (
                "effects",
                &(|own: &str| !effects.contains(&own)) as &dyn Fn(&str) -> bool,
            ),
            ("effect_files", &|own| files.contains_key(own)),
        ] {
            if let Some(list) = model.get_mut(key).and_then(toml_edit::Item::as_array_mut) {
                list.retain(|value| value.as_str().is_none_or(is_kept));
            }
        }
    }
    let priors = document
        .get_mut("priors")
        .and_then(toml_edit::Item::as_table_like_mut);
    if let Some(priors) = priors {
        let of_effect = |key: &str| key.split_once('.').is_some_and(|(own, _)| effects.contains(&own));
        let lines: Vec<String> = priors.iter().map(|(key, _)| key.to_owned()).collect();
        for line in lines.iter().filter(|line| of_effect(line)) {
            priors.remove(line);
        }
    }
    Ok(FileSet {
        toml: document.to_string(),
        files,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_goes_with_all_that_is_said_of_it() {
        let job = FileSet {
            toml: "[model]\nkind = \"scm\"\neffects = [\"hard_pan\", \"adhesion\"]\neffect_files = [\"mine.toml\"]\n[priors]\nn = 1.1\n\"adhesion.pull_off_pa\" = 3.0\n".into(),
            files: [(
                "mine.toml".to_owned(),
                "name = \"mine\"\nsummary = \"s\"\nsource = \"s\"\nshear = \"tau\"\n".to_owned(),
            )]
            .into(),
        };
        let without = reduced_job("job.toml", &job, &["adhesion", "mine"]).unwrap();
        assert_eq!(
            without.toml,
            "[model]\nkind = \"scm\"\neffects = [\"hard_pan\"]\neffect_files = []\n[priors]\nn = 1.1\n"
        );
        assert!(without.files.is_empty());
        assert_eq!(reduced_job("job.toml", &job, &["n"]).unwrap(), job);
    }
}
