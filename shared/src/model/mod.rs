//! Which forward model is meant, and the self-contained variant of it that a worker evaluates.
//!
//! # Layout
//! - here: [`ModelKind`], [`Condition`] and [`ModelVariant`].
//! - [`settings`]: the table `[model]` of a job.
//! - [`spatial`]: what the three-dimensional model needs beside.

pub mod settings;
pub mod spatial;

pub use settings::ModelSettings;
use spatial::Displacement;
pub use spatial::SpatialSettings;

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use utoipa::ToSchema;

use crate::experiment::{Experiment, Protocol, TestRun, Wheel};
use crate::parameters::{self, check_complete, check_value, lookup};

/// The forward models by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelKind {
    /// The smooth-wheel quasi-static Soil Contact Model.
    QuasiStatic,
    /// The three-dimensional Soil Contact Model: a wheel that rolls over deformable terrain.
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
    /// Angle of repose of the run's soil `[deg]`, for a model whose soil slides; absent: the model's default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repose_angle_deg: Option<f64>,
}

impl Condition {
    fn new(run: &TestRun, repose_angle_deg: Option<f64>) -> Self {
        Condition {
            repose_angle_deg,
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
    /// What the three-dimensional model needs beside; absent for the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spatial: Option<SpatialSettings>,
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
        for parameter in parameters::of_kind(settings.kind) {
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
        let slides = settings.kind == ModelKind::Scm;
        let variant = ModelVariant {
            kind: settings.kind,
            spatial: settings.spatial,
            effects: Vec::new(),
            parameters,
            fixed,
            wheels: experiment.wheels.clone(),
            gravity_m_s2: experiment.rig.gravity_m_s2,
            conditions: runs
                .into_iter()
                .map(|run| {
                    Condition::new(
                        run,
                        slides
                            .then(|| experiment.soils[&run.soil].repose_angle_deg)
                            .flatten(),
                    )
                })
                .collect(),
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
        if self.conditions.is_empty() {
            return Ok(());
        }
        let names = || self.parameters.iter().chain(self.fixed.keys());
        if let Some(spatial) = &self.spatial {
            spatial.check_protocol(&self.protocol)?;
            if spatial.displacement != Displacement::Rim && !names().any(|n| n == parameters::SHEAR_MODULUS) {
                return Err(format!(
                    "displacement has no effect without {}",
                    parameters::SHEAR_MODULUS
                ));
            }
        }
        if self.kind == ModelKind::Scm {
            return match self.conditions.iter().find(|c| self.has_mesh(&c.wheel)) {
                Some(Condition { wheel, .. }) if names().any(|n| n.starts_with("wheel_radius_m")) => {
                    Err(format!(
                        "wheel {wheel} is a surface mesh, which has its radius: wheel_radius_m cannot be a parameter"
                    ))
                }
                _ => Ok(()),
            };
        }
        if let Some(name) = names().find(|n| parameters::SPATIAL.iter().any(|p| p.name == *n)) {
            return Err(format!(
                "{name}: quasi_static has no terrain that deforms; use kind = \"scm\""
            ));
        }
        for condition in &self.conditions {
            let name = &condition.wheel;
            if self.has_mesh(name) {
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

    fn has_mesh(&self, wheel: &str) -> bool {
        self.wheels.get(wheel).is_some_and(|wheel| wheel.mesh.is_some())
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
