//! The table `[model]` of a job, or the model file of `worker simulate`.

use std::collections::BTreeMap;

use super::effects::EffectSet;
use super::error::ModelError;
use super::external::ExternalModel;
use super::external_table;
use super::grouser_key;
use super::kind::ModelKind;
use super::spatial::SpatialSettings;
use formula::catalogue;

use crate::file::{number, unknown_word};
use crate::parameters;

/// The content of the table `[model]`.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelSettings {
    /// The forward model.
    pub kind: ModelKind,
    /// Settings of the three-dimensional model.
    pub spatial: Option<SpatialSettings>,
    /// True if the quasi-static model rolls the grousers that wheels have.
    pub rolls_grousers: bool,
    /// The external model, if the kind is one.
    pub external: Option<ExternalModel>,
    /// Values of the fixed parameters.
    pub fixed: BTreeMap<String, f64>,
    /// Names of the listed effects of the catalogue.
    pub effects: Vec<String>,
    /// Names of effect files.
    pub effect_files: Vec<String>,
}

impl ModelSettings {
    /// Reads the table `[model]`; [`ModelError`] names the key, the value and the allowed values.
    pub fn from_table(table: &toml::Table) -> Result<Self, ModelError> {
        let kind = kind_of(table)?;
        let (mut spatial, mut external_keys) = (toml::Table::new(), toml::Table::new());
        let mut remaining = Vec::new();
        let (mut effects, mut effect_files) = (Vec::new(), Vec::new());
        let mut rolls_grousers = false;
        for (key, value) in table {
            match key.as_str() {
                "kind" => {}
                "effects" => effects = words("effects", value)?,
                "effect_files" => effect_files = words("effect_files", value)?,
                key if kind.is_external() && external_table::KEYS.contains(&key) => {
                    external_keys.insert(key.to_owned(), value.clone());
                }
                key if SpatialSettings::keys().contains(&key) => {
                    spatial.insert(key.to_owned(), value.clone());
                }
                grouser_key::KEY if !kind.is_external() => {
                    rolls_grousers = grouser_key::read(kind, value)?;
                }
                key => remaining.push((key, value)),
            }
        }
        let external = match kind.is_external() {
            true => Some(external_table::external(kind, &external_keys)?),
            false => None,
        };
        let mut fixed = BTreeMap::new();
        for (key, value) in remaining {
            fixed.insert(key.to_owned(), fixed_parameter(key, value, external.as_ref())?);
        }
        let spatial = match (kind, spatial.keys().next()) {
            (ModelKind::Scm, _) => Some(SpatialSettings::from_table(spatial)?),
            (_, None) => None,
            (kind, Some(key)) => {
                return Err(ModelError::Invalid(format!(
                    "{key}: {} has no terrain of nodes; use kind = \"scm\"",
                    kind.name()
                )));
            }
        };
        let mut settings = ModelSettings {
            kind,
            spatial,
            rolls_grousers,
            external,
            fixed,
            effects: Vec::new(),
            effect_files: Vec::new(),
        };
        settings.add_effects(&effects, &effect_files)?;
        Ok(settings)
    }

    /// Returns the keys that only a model of this kind has, in addition to its parameters.
    pub fn keys_of(kind: ModelKind) -> &'static [&'static str] {
        match kind {
            ModelKind::QuasiStatic => &[grouser_key::KEY],
            ModelKind::Scm => SpatialSettings::keys(),
            ModelKind::WongReece | ModelKind::Rft => &[],
            ModelKind::Command | ModelKind::Umbridge => &external_table::KEYS,
        }
    }

    /// Returns whether the model rolls smooth rims, whatever grousers are declared.
    pub fn is_smooth(&self) -> bool {
        self.kind.is_smooth() && !self.rolls_grousers
    }

    /// Adds effects of the catalogue by name, and effect files. [`ModelError`] names the effect that is unknown or listed
    /// already, or the number of effects.
    pub fn add_effects(&mut self, effects: &[String], files: &[String]) -> Result<(), ModelError> {
        // This check comes first, because the checks below compare every pair of names.
        EffectSet::check_count(self.effects.len() + self.effect_files.len() + effects.len() + files.len())?;
        for name in effects {
            if name.ends_with(".toml") {
                return Err(ModelError::Invalid(format!(
                    "effects: \"{name}\" looks like a file, which belongs under effect_files"
                )));
            }
            if catalogue::find(name).is_none() {
                return Err(ModelError::Unknown(unknown_effect(name)));
            }
        }
        for (key, list, new_names) in [
            ("effects", &mut self.effects, effects),
            ("effect_files", &mut self.effect_files, files),
        ] {
            for name in new_names {
                if list.contains(name) {
                    return Err(ModelError::Invalid(format!("{key}: \"{name}\" appears twice")));
                }
                list.push(name.clone());
            }
        }
        Ok(())
    }
}

/// Reads a list of words.
fn words(key: &str, value: &toml::Value) -> Result<Vec<String>, ModelError> {
    let word = |v: &toml::Value| v.as_str().map(str::to_owned);
    let words: Option<Vec<String>> = value.as_array().and_then(|list| list.iter().map(word).collect());
    words.ok_or_else(|| ModelError::Invalid(format!("{key} = {value} must be a list of names in quotes")))
}

/// Returns `unknown effect "bulldosing"; the nearest known is "bulldozing"`.
pub fn unknown_effect(name: &str) -> String {
    unknown_word(
        "effect",
        name,
        catalogue::catalogue().iter().map(|e| e.name.as_str()),
    )
}

/// Reads the value of `kind`.
fn kind_of(table: &toml::Table) -> Result<ModelKind, ModelError> {
    let names = || ModelKind::ALL.iter().map(|kind| kind.name());
    let list = names()
        .map(|name| format!("\"{name}\""))
        .collect::<Vec<_>>()
        .join(", ");
    match table.get("kind") {
        Some(toml::Value::String(name)) => {
            ModelKind::find(name).ok_or_else(|| ModelError::Unknown(unknown_word("kind", name, names())))
        }
        Some(other) => Err(ModelError::Invalid(format!(
            "kind = {other} must be one of {list}"
        ))),
        None => Err(ModelError::Incomplete(format!("kind is missing: one of {list}"))),
    }
}

fn fixed_parameter(
    key: &str,
    value: &toml::Value,
    external: Option<&ExternalModel>,
) -> Result<f64, ModelError> {
    if let Some(within) = value.as_table().and_then(|table| table.keys().next()) {
        return Err(ModelError::Invalid(format!(
            "write the name in quotes: \"{key}.{within}\""
        )));
    }
    // the part before a dot may name an effect of a file that is read later
    let base: Vec<&str> = match external {
        None => parameters::model_parameters().map(|p| p.name).collect(),
        Some(model) => {
            let parameters = model.parameters.iter().map(|p| p.name.as_str());
            parameters.chain(["wheel_radius_m"]).collect()
        }
    };
    if !key.contains('.') && !base.contains(&key) {
        let kinds: &[ModelKind] = match external {
            None => &[ModelKind::QuasiStatic, ModelKind::Scm],
            Some(_) => &[ModelKind::Command],
        };
        let keys = kinds.iter().flat_map(|kind| ModelSettings::keys_of(*kind));
        let names = base.into_iter().chain(["kind", "effects", "effect_files"]);
        let names = names.chain(keys.copied());
        return Err(ModelError::Unknown(unknown_word("key", key, names)));
    }
    number(value).ok_or_else(|| ModelError::Invalid(format!("{key} must be a number, not {value}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_that_is_too_long_is_refused_for_its_length_alone() {
        for (key, end) in [("effects", ""), ("effect_files", ".toml")] {
            // all names are unknown, and the last appears twice
            let mut names: Vec<String> = (0..60_000).map(|i| format!("\"e{i}{end}\"")).collect();
            names[59_999] = names[0].clone();
            let table = format!("kind = \"scm\"\n{key} = [{}]", names.join(", "));
            let refused = ModelSettings::from_table(&toml::from_str(&table).unwrap()).unwrap_err();
            assert_eq!(refused.to_string(), "60000 effects must be at most 10");
        }
    }
}
