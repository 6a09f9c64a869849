//! The job of a model with more effects: the same job, and what is added to it.

use shared::file::FileError;
use shared::model::{ModelKind, ModelSettings};
use shared::parameters::SPATIAL;

use super::one_model::keep_model;
use crate::model_switch::ModelSwitch;

/// A job to be changed: of several models that it compares, the first.
fn document(name: &str, toml: &str) -> Result<toml_edit::DocumentMut, FileError> {
    let document = toml.parse();
    let mut document: toml_edit::DocumentMut =
        document.map_err(|e: toml_edit::TomlError| FileError::whole(name, e.to_string()))?;
    keep_model(&mut document, 0).map_err(|e| FileError::whole(name, e))?;
    Ok(document)
}

/// The text of a job with further effects and effect files under `[model]` and further lines under `[priors]`; everything
/// else stays as it is written.
///
/// # Arguments
/// - `name`: how messages call the job.
/// - `priors`: full names of parameters, each with its number or its distribution.
///
/// # Errors
/// [`FileError`] where the text is no job with a table `[model]`, or where a line of `[priors]` is there already.
pub fn extended_job(
    name: &str,
    toml: &str,
    effects: &[String],
    files: &[String],
    priors: &[(String, toml::Value)],
) -> Result<String, FileError> {
    if effects.is_empty() && files.is_empty() && priors.is_empty() {
        return Ok(toml.to_owned());
    }
    let fail = |message: String| FileError::whole(name, message);
    let mut document = document(name, toml)?;
    let model = document
        .get_mut("model")
        .and_then(toml_edit::Item::as_table_like_mut);
    let model = model.ok_or_else(|| fail("[model] is missing".into()))?;
    for (key, names) in [("effects", effects), ("effect_files", files)] {
        if names.is_empty() {
            continue;
        }
        let list = model
            .entry(key)
            .or_insert(toml_edit::value(toml_edit::Array::new()));
        let list = list
            .as_array_mut()
            .ok_or_else(|| fail(format!("{key} must be a list")))?;
        list.extend(names.iter().map(String::as_str));
    }
    if !priors.is_empty() {
        let table = document.entry("priors").or_insert(toml_edit::table());
        let table = table
            .as_table_like_mut()
            .ok_or_else(|| fail("[priors] must be a table".into()))?;
        for (parameter, prior) in priors {
            // As TOML writes it on one line, which is how a prior stands in a job.
            let prior: toml_edit::Value = prior
                .to_string()
                .parse()
                .map_err(|e: toml_edit::TomlError| fail(format!("{parameter}: {e}")))?;
            if table.insert(parameter, toml_edit::value(prior)).is_some() {
                return Err(fail(format!("{parameter} is already under [priors]")));
            }
        }
    }
    Ok(document.to_string())
}

/// The text of a job with another setting of its model. A job of another kind loses the settings that only its own kind has.
///
/// # Errors
/// [`FileError`] where the text is no job with a table `[model]`.
pub fn with_setting(name: &str, toml: &str, switch: &ModelSwitch) -> Result<String, FileError> {
    let fail = |message: String| FileError::whole(name, message);
    let mut document = document(name, toml)?;
    let model = document
        .get_mut("model")
        .and_then(toml_edit::Item::as_table_like_mut);
    let model = model.ok_or_else(|| fail("[model] is missing".into()))?;
    if switch.is_kind() {
        let keys = [ModelKind::QuasiStatic, ModelKind::Scm]
            .into_iter()
            .flat_map(ModelSettings::keys_of);
        for key in SPATIAL.iter().map(|p| p.name).chain(keys.copied()) {
            model.remove(key);
        }
    }
    model.insert(switch.key, toml_edit::value(switch.value));
    Ok(document.to_string())
}

/// The text of a job in which a parameter is free that it holds fixed: under `[model]`, under `[priors]`, or in silence.
///
/// # Errors
/// [`FileError`] where the text is no job with a table `[model]`, or where the parameter has a prior already.
pub fn with_free(name: &str, toml: &str, parameter: &str, prior: &toml::Value) -> Result<String, FileError> {
    let mut document = document(name, toml)?;
    for table in ["model", "priors"] {
        let Some(table) = document
            .get_mut(table)
            .and_then(toml_edit::Item::as_table_like_mut)
        else {
            continue;
        };
        if table
            .get(parameter)
            .is_some_and(|held| held.is_float() || held.is_integer())
        {
            table.remove(parameter);
        }
    }
    let toml = document.to_string();
    extended_job(name, &toml, &[], &[], &[(parameter.to_owned(), prior.clone())])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_kind_leaves_the_settings_of_its_own() {
        let job = "[model]\nkind = \"scm\" # three dimensions\ndem_spacing_m = 0.005\nflow_fraction = 0.2\ncohesion_pa = 5.0\n";
        let turned = |name| with_setting("job.toml", job, ModelSwitch::find(name).unwrap()).unwrap();
        assert_eq!(
            turned("kind_quasi_static"),
            "[model]\nkind = \"quasi_static\"\ncohesion_pa = 5.0\n"
        );
        let rolled = "[model]\nkind = \"quasi_static\"\ngrousers = \"rolled\"\n";
        assert_eq!(
            with_setting("job.toml", rolled, ModelSwitch::find("kind_scm").unwrap()).unwrap(),
            "[model]\nkind = \"scm\"\n"
        );
        let node = turned("displacement_node");
        assert!(
            node.ends_with("cohesion_pa = 5.0\ndisplacement = \"node\"\n"),
            "{node}"
        );
    }

    const JOB: &str = "# why\n[model]\nkind = \"scm\" # here\neffects = [\"hard_pan\"]\n\n[priors]\nn = 1.1\n\n[sampler]\nseed = 3\n";

    fn extended(toml: &str, priors: &[(&str, &str)]) -> Result<String, String> {
        let read = |(name, value): &(&str, &str)| {
            let table: toml::Table = format!("x = {value}").parse().unwrap();
            ((*name).to_owned(), table["x"].clone())
        };
        let priors: Vec<(String, toml::Value)> = priors.iter().map(read).collect();
        extended_job(
            "job.toml",
            toml,
            &["adhesion".into()],
            &["mine.toml".into()],
            &priors,
        )
        .map_err(|e| e.to_string())
    }

    #[test]
    fn additions_join_those_of_the_job_and_leave_the_rest_as_it_is() {
        let added = extended(JOB, &[("hard_pan.x.w", "{ half_normal = 25.0 }"), ("a.b", "0.5")]).unwrap();
        let expected = JOB
            .replace(
                "[\"hard_pan\"]",
                "[\"hard_pan\", \"adhesion\"]\neffect_files = [\"mine.toml\"]",
            )
            .replace(
                "n = 1.1\n",
                "n = 1.1\n\"hard_pan.x.w\" = { half_normal = 25.0 }\n\"a.b\" = 0.5\n",
            );
        assert_eq!(added, expected);
        assert_eq!(extended_job("job.toml", JOB, &[], &[], &[]).unwrap(), JOB);
    }

    #[test]
    fn a_parameter_is_freed_wherever_it_is_held() {
        let table: toml::Table = "x = { half_normal = 500.0 }".parse().unwrap();
        let free = |toml: &str| with_free("job.toml", toml, "cohesion_pa", &table["x"]);
        let expected = "[model]\n[priors]\nn = 1.1\ncohesion_pa = { half_normal = 500.0 }\n";
        for held in [
            "[model]\n[priors]\nn = 1.1\n",
            "[model]\ncohesion_pa = 0.0\n[priors]\nn = 1.1\n",
            "[model]\n[priors]\ncohesion_pa = 0\nn = 1.1\n",
        ] {
            assert_eq!(free(held).unwrap(), expected);
        }
        let twice = free(expected).unwrap_err();
        assert_eq!(
            twice.to_string(),
            "job.toml: cohesion_pa is already under [priors]"
        );
    }

    #[test]
    fn what_cannot_be_added_is_said() {
        let twice = extended(JOB, &[("n", "1.2")]).unwrap_err();
        assert_eq!(twice, "job.toml: n is already under [priors]");
        let none = extended("[priors]\nn = 1.1\n", &[]).unwrap_err();
        assert_eq!(none, "job.toml: [model] is missing");
        let no_list = extended("[model]\neffects = 1\n", &[]).unwrap_err();
        assert_eq!(no_list, "job.toml: effects must be a list");
    }
}
