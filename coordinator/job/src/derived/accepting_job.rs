//! A job that answers more questions.

use shared::file::FileError;

/// The text of a job with further names under `accept`; everything else stays as it is written.
///
/// # Arguments
/// - `name`: how messages call the job.
/// - `accepted`: names of questions; those that are there already are not repeated.
///
/// # Errors
/// [`FileError`] where the text is no TOML, or `accept` no list.
pub fn accepting_job(name: &str, toml: &str, accepted: &[String]) -> Result<String, FileError> {
    if accepted.is_empty() {
        return Ok(toml.to_owned());
    }
    let fail = |message: String| FileError::whole(name, message);
    let mut document: toml_edit::DocumentMut = toml
        .parse()
        .map_err(|e: toml_edit::TomlError| fail(e.to_string()))?;
    let list = document
        .entry("accept")
        .or_insert(toml_edit::value(toml_edit::Array::new()));
    let list = list
        .as_array_mut()
        .ok_or_else(|| fail("accept must be a list of names in quotes".into()))?;
    for name in accepted {
        if !list.iter().any(|there| there.as_str() == Some(name)) {
            list.push(name);
        }
    }
    Ok(document.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_added_once_and_nothing_else_changes() {
        let names = ["radius_m", "data_few"].map(str::to_owned);
        let job = "# mine\naccept = [\"data_few\"]\n[model]\nkind = \"scm\" # 3-D\n";
        assert_eq!(
            accepting_job("job.toml", job, &names).unwrap(),
            job.replace("[\"data_few\"]", "[\"data_few\", \"radius_m\"]")
        );
        let without = "# mine\n[model]\nkind = \"scm\"\n";
        let with = accepting_job("job.toml", without, &names).unwrap();
        let table: toml::Table = toml::from_str(&with).unwrap();
        assert_eq!(table["accept"].as_array().unwrap().len(), 2);
        assert_eq!(accepting_job("job.toml", without, &[]).unwrap(), without);
    }
}
