//! Which forward model is meant, and the self-contained variant of it that a worker evaluates.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use utoipa::ToSchema;

use crate::experiment::{Experiment, Protocol, TestRun, Wheel};
use crate::file::unknown_word;
use crate::parameters::{self, check_complete, check_value, lookup};

/// The forward models by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelKind {
    /// The smooth-wheel quasi-static Soil Contact Model.
    QuasiStatic,
    /// The three-dimensional Soil Contact Model. Not available in this version.
    Scm,
}

impl ModelKind {
    /// Name in files and results.
    pub fn name(self) -> &'static str {
        match self {
            ModelKind::QuasiStatic => "quasi_static",
            ModelKind::Scm => "scm",
        }
    }
}

/// The table `[model]` of a job, or a model file of `worker simulate`.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelSettings {
    /// Which forward model.
    pub kind: ModelKind,
    /// Base parameters that are fixed.
    pub fixed: BTreeMap<String, f64>,
}

/// What a later version understands; here it is named, so that it is refused by name.
const LATER: [&str; 3] = ["effect_files", "dem_spacing_m", "displacement"];

impl ModelSettings {
    /// Reads the table `[model]`.
    ///
    /// # Errors
    /// A sentence that names the key, the value and what is allowed.
    pub fn from_table(table: &toml::Table) -> Result<Self, String> {
        let mut kind = None;
        let mut fixed = BTreeMap::new();
        for (key, value) in table {
            match (key.as_str(), value) {
                ("kind", toml::Value::String(name)) => {
                    kind = Some(match name.as_str() {
                        "quasi_static" => ModelKind::QuasiStatic,
                        "scm" => return Err("kind = \"scm\" is not available in this version".into()),
                        other => return Err(unknown_word("kind", other, ["quasi_static", "scm"])),
                    });
                }
                ("effects", toml::Value::Array(names)) if names.is_empty() => {}
                ("effects", _) => return Err("effects are not available in this version".into()),
                (key, _) if LATER.contains(&key) => {
                    return Err(format!("{key} is not available in this version"));
                }
                (key, value) => {
                    let number = value.as_float().or_else(|| value.as_integer().map(|i| i as f64));
                    let mut parameters = parameters::BASE.iter().chain(&parameters::EFFECTS);
                    let known = key.starts_with("wheel_radius_m.") || parameters.any(|p| p.name == key);
                    if !known {
                        let names = parameters::BASE.iter().map(|p| p.name).chain(["kind", "effects"]);
                        return Err(unknown_word("key", key, names));
                    }
                    let number = number.ok_or_else(|| format!("{key} must be a number, not {value}"))?;
                    fixed.insert(key.to_owned(), number);
                }
            }
        }
        let kind = kind.ok_or("kind is missing: \"quasi_static\" or \"scm\"")?;
        Ok(ModelSettings { kind, fixed })
    }
}

/// A condition of the rig, as the simulation needs it; measurements stay with the coordinator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// Name of the wheel in [`ModelVariant::wheels`].
    pub wheel: String,
    /// Slip by the rig's radius, in [-1, 1).
    pub slip: f64,
    /// Vertical load `[N]`.
    pub wheel_load_n: f64,
    /// Sled speed along travel `[m/s]`.
    pub sled_speed_m_s: f64,
    /// From wheel heading to travel `[deg]`.
    pub slip_angle_deg: f64,
    /// How often the wheel passes; the last pass counts.
    pub pass: u32,
}

impl From<&TestRun> for Condition {
    fn from(run: &TestRun) -> Self {
        Condition {
            wheel: run.wheel.clone(),
            slip: run.slip,
            wheel_load_n: run.wheel_load_n,
            sled_speed_m_s: run.sled_speed_m_s,
            slip_angle_deg: run.slip_angle_deg,
            pass: run.pass,
        }
    }
}

/// Everything that maps a parameter vector to observables; a worker fetches it once, by its hash.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelVariant {
    /// Which forward model.
    pub kind: ModelKind,
    /// Names of the effects switched on. Empty in this version.
    pub effects: Vec<String>,
    /// Names of the free parameters, in the order of every parameter vector.
    pub parameters: Vec<String>,
    /// Values of the fixed parameters.
    pub fixed: BTreeMap<String, f64>,
    /// The wheels by name.
    #[schema(value_type = Object)]
    pub wheels: BTreeMap<String, Wheel>,
    /// Acceleration of gravity `[m/s^2]`.
    pub gravity_m_s2: f64,
    /// The conditions to simulate, in the order of the observables.
    pub conditions: Vec<Condition>,
    /// How histories become averages.
    #[schema(value_type = Object)]
    pub protocol: Protocol,
}

impl ModelVariant {
    /// Puts together the variant of some of an experiment's runs; base parameters that are neither free
    /// nor fixed take their defaults.
    ///
    /// # Errors
    /// A sentence that names a parameter that is unknown, out of bounds, missing or said twice.
    pub fn new<'a>(
        experiment: &Experiment,
        settings: &ModelSettings,
        parameters: Vec<String>,
        runs: impl IntoIterator<Item = &'a TestRun>,
    ) -> Result<Self, String> {
        let wheels = experiment.wheel_names();
        let mut fixed = settings.fixed.clone();
        for parameter in parameters::BASE {
            let Some(default) = parameter.default else {
                continue;
            };
            if !parameters.iter().any(|p| p == parameter.name) {
                fixed.entry(parameter.name.to_owned()).or_insert(default);
            }
        }
        for (name, &value) in &fixed {
            check_value(&lookup(name, &wheels)?, name, value)?;
        }
        if let Some(twice) = parameters.iter().find(|p| fixed.contains_key(*p)) {
            return Err(format!("parameter {twice} is both fixed and free"));
        }
        let names: BTreeSet<&str> = parameters
            .iter()
            .chain(fixed.keys())
            .map(String::as_str)
            .collect();
        check_complete(&names, &wheels)?;
        let variant = ModelVariant {
            kind: settings.kind,
            effects: Vec::new(),
            parameters,
            fixed,
            wheels: experiment.wheels.clone(),
            gravity_m_s2: experiment.rig.gravity_m_s2,
            conditions: runs.into_iter().map(Condition::from).collect(),
            protocol: experiment.protocol.clone(),
        };
        variant.check_expressible()?;
        Ok(variant)
    }

    /// Checks that the forward model can express what the variant asks of a wheel. Without conditions no wheel
    /// rolls, and nothing is asked of it.
    ///
    /// # Errors
    /// A sentence that names what the model of this kind lacks.
    pub fn check_expressible(&self) -> Result<(), String> {
        if self.kind != ModelKind::QuasiStatic || self.conditions.is_empty() {
            return Ok(());
        }
        for condition in &self.conditions {
            let name = &condition.wheel;
            if self.wheels.get(name).is_some_and(|wheel| wheel.mesh.is_some()) {
                return Err(format!(
                    "wheel {name} is a surface mesh: quasi_static rolls a smooth cylinder; use kind = \"scm\""
                ));
            }
        }
        let modulus = parameters::SHEAR_MODULUS;
        let fixed = self.fixed.get(modulus).is_some_and(|k| k.abs() > 0.0);
        if fixed || self.parameters.iter().any(|p| p == modulus) {
            return Err(format!(
                "{modulus}: janosi_hanamoto is not available in this version for quasi_static; 0 m is without it"
            ));
        }
        Ok(())
    }

    /// Name of the variant on the wire: the first 128 bits of the SHA-256 of its JSON, in hex.
    pub fn hash(&self) -> String {
        // Struct fields and ordered maps serialise in one order, so equal variants have equal text.
        let text = serde_json::to_vec(self).expect("a variant holds only numbers, text and ordered maps");
        Sha256::digest(&text)[..16]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }
}
