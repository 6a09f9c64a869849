//! Which forward model is meant, and the self-contained variant of it that a worker evaluates.
//!
//! # Layout
//! - here: [`ModelKind`], [`Condition`], [`PlateCondition`], [`RingCondition`] and [`ModelVariant`].
//! - [`effects`]: which effects, in which order, and where the values of their parameters stand.
//! - [`metamodel`]: the quasi-static model beside the three-dimensional one.
//! - [`settings`]: the table `[model]` of a job.
//! - [`spatial`]: what the three-dimensional model needs beside.

pub mod effects;
pub mod metamodel;
pub mod settings;
pub mod spatial;

pub use effects::{EffectSet, EffectText};
use formula::effect::Mechanism;
use formula::{Effect, Hook, Variable};
pub use metamodel::Companion;
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
    /// Density of the run's soil `[kg/m^3]`; absent where no effect asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_kg_m3: Option<f64>,
}

impl Condition {
    fn new(run: &TestRun, repose_angle_deg: Option<f64>, density_kg_m3: Option<f64>) -> Self {
        Condition {
            repose_angle_deg,
            density_kg_m3,
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
    /// The effects, in the order of their evaluation.
    pub effects: Vec<EffectText>,
    /// Names of the free parameters, in the order of every parameter vector.
    pub parameters: Vec<String>,
    /// Values of the fixed parameters.
    pub fixed: BTreeMap<String, f64>,
    /// The wheels by name.
    #[schema(value_type = Object)]
    pub wheels: BTreeMap<String, Wheel>,
    /// Acceleration of gravity `[m/s^2]`.
    pub gravity_m_s2: f64,
    /// Length of the soil bin `[m]`; absent where no effect asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bin_length_m: Option<f64>,
    /// The conditions to simulate, in the order of the observables.
    pub conditions: Vec<Condition>,
    /// How histories become averages.
    #[schema(value_type = Object)]
    pub protocol: Protocol,
    /// Whether each condition is simulated once more on soil that is a little stiffer, for the derivatives by ln k*.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub stiffness_sensitivity: bool,
    /// Whether what each run felt over time comes back, too; only a model that rolls in time has that.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub histories: bool,
    /// Readings of plates to predict beside.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plates: Vec<PlateCondition>,
    /// Readings of rings to predict beside.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rings: Vec<RingCondition>,
    /// The quasi-static model beside, where a metamodel is made of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub companion: Option<Companion>,
}

/// A plate in the soil; what it measured stays with the coordinator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PlateCondition {
    /// Radius of the round plate `[m]`.
    pub plate_radius_m: f64,
    /// Sinkage `[m]`.
    pub sinkage_m: f64,
}

/// A ring on the soil; what it measured stays with the coordinator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct RingCondition {
    /// Normal stress under the ring `[Pa]`.
    pub normal_stress_pa: f64,
    /// Displacement at the ring's mean radius `[m]`.
    pub shear_displacement_m: f64,
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
        effects: &EffectSet,
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
            check_value(&lookup(name, &wheels, effects)?, name, value)?;
        }
        if let Some(twice) = parameters.iter().find(|p| fixed.contains_key(*p)) {
            return Err(format!("parameter {twice} is both fixed and free"));
        }
        let names: BTreeSet<&str> = parameters
            .iter()
            .chain(fixed.keys())
            .map(String::as_str)
            .collect();
        check_complete(&names, &wheels, effects)?;
        check_grousers(effects, &names, experiment)?;
        let slides = settings.kind == ModelKind::Scm;
        let (weighing, walled) = (
            effects.using(Variable::Density),
            effects.using(Variable::BinLength),
        );
        let condition = |run: &TestRun| {
            let soil = &experiment.soils[&run.soil];
            if let (Some(effect), None) = (weighing, soil.density_kg_m3) {
                return Err(format!(
                    "effect {} needs density_kg_m3 of soil {}",
                    effect.name, run.soil
                ));
            }
            let repose_angle_deg = soil.repose_angle_deg.filter(|_| slides);
            let density_kg_m3 = soil.density_kg_m3.filter(|_| weighing.is_some());
            Ok(Condition::new(run, repose_angle_deg, density_kg_m3))
        };
        let conditions = runs.into_iter().map(condition).collect::<Result<Vec<_>, _>>()?;
        let bin_length_m = experiment.rig.bin_length_m.filter(|_| walled.is_some());
        if let (Some(effect), None, false) = (walled, bin_length_m, conditions.is_empty()) {
            return Err(format!("effect {} needs bin_length_m under [rig]", effect.name));
        }
        let variant = ModelVariant {
            kind: settings.kind,
            spatial: settings.spatial,
            effects: effects.texts(),
            parameters,
            fixed,
            wheels: experiment.wheels.clone(),
            gravity_m_s2: experiment.rig.gravity_m_s2,
            bin_length_m,
            conditions,
            protocol: experiment.protocol.clone(),
            stiffness_sensitivity: false,
            histories: false,
            plates: Vec::new(),
            rings: Vec::new(),
            companion: None,
        };
        variant.check_expressible(effects)?;
        Ok(variant)
    }

    /// Checks that the forward model can express what the variant and its effects ask of a wheel. Without conditions no
    /// wheel rolls, and nothing is asked of it.
    ///
    /// # Errors
    /// A sentence that names what the model of this kind lacks.
    pub fn check_expressible(&self, effects: &EffectSet) -> Result<(), String> {
        if self.conditions.is_empty() {
            return Ok(());
        }
        if let Some(spatial) = &self.spatial {
            spatial.check_protocol(&self.protocol)?;
            if spatial.displacement != Displacement::Rim && effects.using(Variable::J).is_none() {
                return Err(
                    "displacement has no effect without an effect that uses j, such as janosi_hanamoto"
                        .into(),
                );
            }
        }
        let meshes: BTreeSet<&str> = self.conditions.iter().map(|c| c.wheel.as_str()).collect();
        let meshes: BTreeSet<&str> = meshes.into_iter().filter(|wheel| self.has_mesh(wheel)).collect();
        let names: BTreeSet<&str> = self.names().collect();
        match self.kind {
            ModelKind::Scm => self.check_meshes(effects, &names, &meshes),
            ModelKind::QuasiStatic => {
                if let Some(name) = names
                    .iter()
                    .find(|n| parameters::SPATIAL.iter().any(|p| p.name == **n))
                {
                    return Err(format!(
                        "{name}: quasi_static has no terrain that deforms; use kind = \"scm\""
                    ));
                }
                match meshes.first() {
                    Some(wheel) => Err(format!(
                        "wheel {wheel} is a surface mesh: quasi_static rolls a smooth cylinder; use kind = \"scm\""
                    )),
                    None => Ok(()),
                }
            }
        }
    }

    /// Checks that nothing asks of a surface mesh what only a rim can do.
    fn check_meshes(
        &self,
        effects: &EffectSet,
        names: &BTreeSet<&str>,
        meshes: &BTreeSet<&str>,
    ) -> Result<(), String> {
        let Some(wheel) = meshes.first() else {
            return Ok(());
        };
        if names.iter().any(|n| n.starts_with("wheel_radius_m")) {
            return Err(format!(
                "wheel {wheel} is a surface mesh, which has its radius: wheel_radius_m cannot be a parameter"
            ));
        }
        for effect in effects.iter() {
            let wheels: BTreeSet<&str> = self.wheels.keys().map(String::as_str).collect();
            let reach = EffectSet::acts_on(effect, names, &wheels);
            let dimension = effect.hooks().find(|h| [Hook::Radius, Hook::Width].contains(h));
            let shapes = effect.mechanism == Some(Mechanism::FlatPatch) || dimension.is_some();
            if let Some(wheel) = meshes.intersection(&reach).next().filter(|_| shapes) {
                return Err(format!(
                    "effect {} reshapes the rim: wheel {wheel} is a surface mesh, which has its shape",
                    effect.name
                ));
            }
        }
        Ok(())
    }

    /// The same runs with what each felt over time, and nothing beside; `None` of a model that knows no time, and without
    /// runs.
    pub fn with_histories(&self) -> Option<Self> {
        let rolls = self.kind == ModelKind::Scm && !self.conditions.is_empty();
        rolls.then(|| ModelVariant {
            histories: true,
            companion: None,
            stiffness_sensitivity: false,
            plates: Vec::new(),
            rings: Vec::new(),
            ..self.clone()
        })
    }

    /// The names of all parameters, free and fixed.
    fn names(&self) -> impl Iterator<Item = &str> {
        self.parameters
            .iter()
            .chain(self.fixed.keys())
            .map(String::as_str)
    }

    /// Version of the model that a worker with these equations computes: its own, and that of the effects. A
    /// calibration is pinned to both; [`equations_of`] is the part that a worker can know.
    pub fn model_version(&self, equations: &str) -> String {
        format!("{equations}{}", EffectSet::version(&self.effects))
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

/// The part of a model's version that names the equations: what stands before the effects.
pub fn equations_of(version: &str) -> &str {
    version
        .split_once('+')
        .map_or(version, |(equations, _)| equations)
}

/// Checks that effects of grousers act on a wheel that has some.
fn check_grousers(
    effects: &EffectSet,
    names: &BTreeSet<&str>,
    experiment: &Experiment,
) -> Result<(), String> {
    let wheels = experiment.wheel_names();
    let of_grousers = |effect: &&Effect| {
        let uses = effect.uses();
        uses.contains(Variable::GrouserCount) || uses.contains(Variable::GrouserHeight)
    };
    for effect in effects.iter().filter(of_grousers) {
        let reach = EffectSet::acts_on(effect, names, &wheels);
        let mut smooth = reach
            .iter()
            .filter(|wheel| !experiment.wheels[**wheel].has_grousers());
        let all = reach.len() == wheels.len() && smooth.clone().count() < reach.len();
        if let Some(wheel) = smooth.next().filter(|_| !all) {
            return Err(format!(
                "effect {} needs a wheel with grousers: {wheel} has none",
                effect.name
            ));
        }
    }
    Ok(())
}
