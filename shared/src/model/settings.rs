//! The table `[model]` of a job, or a model file of `worker simulate`.

use std::collections::BTreeMap;

use super::{ModelKind, SpatialSettings};
use crate::file::unknown_word;
use crate::parameters;

/// The table `[model]`, read.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelSettings {
    /// Which forward model.
    pub kind: ModelKind,
    /// What the three-dimensional model needs beside.
    pub spatial: Option<SpatialSettings>,
    /// Parameters that are fixed.
    pub fixed: BTreeMap<String, f64>,
}

/// What a later version understands; here it is named, so that it is refused by name.
const LATER: [&str; 1] = ["effect_files"];

impl ModelSettings {
    /// Reads the table `[model]`.
    ///
    /// # Errors
    /// A sentence that names the key, the value and what is allowed.
    pub fn from_table(table: &toml::Table) -> Result<Self, String> {
        let mut kind = None;
        let mut fixed = BTreeMap::new();
        let mut spatial = toml::Table::new();
        for (key, value) in table {
            match (key.as_str(), value) {
                ("kind", toml::Value::String(name)) => {
                    kind = Some(match name.as_str() {
                        "quasi_static" => ModelKind::QuasiStatic,
                        "scm" => ModelKind::Scm,
                        other => return Err(unknown_word("kind", other, ["quasi_static", "scm"])),
                    });
                }
                ("effects", toml::Value::Array(names)) if names.is_empty() => {}
                ("effects", _) => return Err("effects are not available in this version".into()),
                (key, _) if LATER.contains(&key) => {
                    return Err(format!("{key} is not available in this version"));
                }
                (key, value) if SpatialSettings::KEYS.contains(&key) => {
                    spatial.insert(key.to_owned(), value.clone());
                }
                (key, value) => {
                    fixed.insert(key.to_owned(), fixed_parameter(key, value)?);
                }
            }
        }
        let kind = kind.ok_or("kind is missing: \"quasi_static\" or \"scm\"")?;
        let spatial = match kind {
            ModelKind::Scm => Some(SpatialSettings::from_table(spatial)?),
            ModelKind::QuasiStatic => match spatial.keys().next() {
                Some(key) => {
                    return Err(format!(
                        "{key}: quasi_static has no terrain of nodes; use kind = \"scm\""
                    ));
                }
                None => None,
            },
        };
        Ok(ModelSettings { kind, spatial, fixed })
    }
}

fn fixed_parameter(key: &str, value: &toml::Value) -> Result<f64, String> {
    let number = value.as_float().or_else(|| value.as_integer().map(|i| i as f64));
    let base = parameters::BASE.iter().chain(&parameters::SPATIAL);
    let known =
        key.starts_with("wheel_radius_m.") || base.clone().chain(&parameters::EFFECTS).any(|p| p.name == key);
    if !known {
        let names = base.map(|p| p.name).chain(["kind", "effects"]);
        return Err(unknown_word("key", key, names.chain(SpatialSettings::KEYS)));
    }
    number.ok_or_else(|| format!("{key} must be a number, not {value}"))
}
