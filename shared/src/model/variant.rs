//! The self-contained variant of a forward model that a worker evaluates.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use formula::{Effect, Variable};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use utoipa::ToSchema;

use super::condition::{PlateCondition, RingCondition, RunCondition, TransientCondition};
use super::effects::{EffectSet, EffectText};
use super::error::ModelError;
use super::external::ExternalModel;
use super::kind::ModelKind;
use super::names::{ParameterScope, check_complete, lookup};
use super::settings::ModelSettings;
use super::spatial::SpatialSettings;
use crate::channel::Channel;
use crate::experiment::{AveragingProtocol, Experiment, TestRun, WheelGeometry};
use crate::outcome::{Observables, SimulatedHistory};
use crate::parameters::check_value;

/// Everything that maps a parameter vector to observables; a worker fetches it once, by its hash.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelVariant {
    /// The forward model.
    pub kind: ModelKind,
    /// Settings of the three-dimensional model; absent for other models.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spatial: Option<SpatialSettings>,
    /// True if the quasi-static model rolls the grousers that wheels have.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rolls_grousers: bool,
    /// The external model, if the kind is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub external: Option<ExternalModel>,
    /// The effects, in the order of their evaluation.
    pub effects: Vec<EffectText>,
    /// Names of the free parameters, in the order of every parameter vector.
    pub parameters: Vec<String>,
    /// Values of the fixed parameters.
    pub fixed: BTreeMap<String, f64>,
    /// The wheels by name.
    #[schema(value_type = Object)]
    pub wheels: BTreeMap<String, WheelGeometry>,
    /// Acceleration of gravity `[m/s^2]`.
    pub gravity_m_s2: f64,
    /// Length of the soil bin `[m]`; absent if no effect uses it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bin_length_m: Option<f64>,
    /// The conditions to simulate, in the order of the observables. Variants of one experiment may share them.
    #[schema(value_type = Vec<RunCondition>)]
    pub conditions: Arc<[RunCondition]>,
    /// The protocol that turns histories into averages.
    #[schema(value_type = Object)]
    pub protocol: AveragingProtocol,
    /// The channels to return; empty: all, with the diagnostics of the contact.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(value_type = Vec<String>)]
    pub channels: Vec<Channel>,
    /// True if each condition is simulated again on slightly stiffer soil, for the derivatives by ln k*.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub stiffness_sensitivity: bool,
    /// True if the time histories of the runs are returned, too; only the three-dimensional model has them.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub histories: bool,
    /// Transients to predict.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transients: Vec<TransientCondition>,
    /// Readings of plates to predict.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plates: Vec<PlateCondition>,
    /// Readings of rings to predict.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rings: Vec<RingCondition>,
    /// Parameters at which an external model must answer: if it fails there, the machine is at fault.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probe: Vec<f64>,
}

impl ModelVariant {
    /// Returns the variant for some of an experiment's runs; base parameters that are neither free nor fixed take their
    /// defaults.
    ///
    /// # Errors
    /// [`ModelError`] names a parameter that is unknown, out of bounds, missing or given twice.
    pub fn new<'a>(
        experiment: &Experiment,
        settings: &ModelSettings,
        effects: &EffectSet,
        parameters: Vec<String>,
        runs: impl IntoIterator<Item = &'a TestRun>,
    ) -> Result<Self, ModelError> {
        let wheels = experiment.wheel_names();
        let scope = ParameterScope {
            wheels: &wheels,
            effects,
            external: settings.external.as_ref(),
        };
        let mut fixed = settings.fixed.clone();
        let stated = settings.external.iter().flat_map(|model| &model.parameters);
        let stated = stated.filter_map(|p| p.base_parameter().filter(|base| base.unit == p.unit));
        for parameter in settings.kind.parameters().chain(stated) {
            let Some(default) = parameter.default else {
                continue;
            };
            if !parameters.iter().any(|p| p == parameter.name) {
                fixed.entry(parameter.name.to_owned()).or_insert(default);
            }
        }
        for (name, &value) in &fixed {
            check_value(&lookup(name, &scope)?, name, value)?;
        }
        if let Some(twice) = parameters.iter().find(|p| fixed.contains_key(*p)) {
            return Err(ModelError::Incomplete(format!(
                "parameter {twice} is both fixed and free"
            )));
        }
        let names: BTreeSet<&str> = parameters
            .iter()
            .chain(fixed.keys())
            .map(String::as_str)
            .collect();
        check_complete(settings.kind, &names, &scope)?;
        check_grousers(effects, &names, experiment)?;
        let slides = settings.kind == ModelKind::Scm;
        let (weighing, walled, drifting) = (
            effects.using(Variable::Density),
            effects.using(Variable::BinLength),
            effects.using(Variable::Order),
        );
        let series = drifting.and(experiment.series());
        let condition = |run: &TestRun| {
            let soil = &experiment.soils[&run.soil];
            if let (Some(effect), None) = (weighing, soil.density_kg_m3) {
                return Err(ModelError::Incomplete(format!(
                    "effect {} needs density_kg_m3 of soil {}",
                    effect.name, run.soil
                )));
            }
            let order = series.and_then(|series| series.position(run));
            if let (Some(effect), None) = (drifting, order) {
                return Err(ModelError::Incomplete(format!(
                    "effect {} needs the column order in runs.csv: the number of each run in time",
                    effect.name
                )));
            }
            Ok(RunCondition {
                repose_angle_deg: soil.repose_angle_deg.filter(|_| slides),
                density_kg_m3: soil.density_kg_m3.filter(|_| weighing.is_some()),
                order,
                ..RunCondition::new(run)
            })
        };
        let conditions = runs.into_iter().map(condition).collect::<Result<Arc<[_]>, _>>()?;
        let bin_length_m = experiment.rig.bin_length_m.filter(|_| walled.is_some());
        if let (Some(effect), None, false) = (walled, bin_length_m, conditions.is_empty()) {
            return Err(ModelError::Incomplete(format!(
                "effect {} needs bin_length_m under [rig]",
                effect.name
            )));
        }
        let variant = ModelVariant {
            kind: settings.kind,
            spatial: settings.spatial,
            rolls_grousers: settings.rolls_grousers,
            external: settings.external.clone(),
            effects: effects.texts(),
            parameters,
            fixed,
            wheels: experiment.wheels.clone(),
            gravity_m_s2: experiment.rig.gravity_m_s2,
            bin_length_m,
            conditions,
            protocol: experiment.protocol.clone(),
            // all channels that the model has
            channels: settings.external.iter().flat_map(|m| m.outputs.clone()).collect(),
            stiffness_sensitivity: false,
            histories: false,
            transients: Vec::new(),
            plates: Vec::new(),
            rings: Vec::new(),
            probe: Vec::new(),
        };
        variant.check_expressible(effects)?;
        Ok(variant)
    }

    /// Returns the variant with the time histories of its runs; `None` for a steady-state model and without runs.
    pub fn with_histories(&self) -> Option<Self> {
        let rolls = self.kind == ModelKind::Scm && !self.conditions.is_empty();
        rolls.then(|| ModelVariant {
            histories: true,
            ..self.clone()
        })
    }

    /// Returns variants for each condition alone.
    pub fn by_condition(&self) -> impl Iterator<Item = Self> {
        self.conditions.iter().enumerate().map(|(run, condition)| {
            let of_run = self.transients.iter().filter(|transient| transient.run == run);
            let alone = |transient: &TransientCondition| TransientCondition {
                run: 0,
                ..transient.clone()
            };
            ModelVariant {
                conditions: Arc::new([condition.clone()]),
                transients: of_run.map(alone).collect(),
                ..self.clone()
            }
        })
    }

    /// Returns the number of points of all transients.
    pub fn transient_points(&self) -> usize {
        self.transients
            .iter()
            .map(|transient| transient.travel_m.len())
            .sum()
    }

    /// Returns the names of all parameters, free and fixed.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.parameters
            .iter()
            .chain(self.fixed.keys())
            .map(String::as_str)
    }

    /// Returns the version of the model that a worker with these equations computes: the version of the equations, the
    /// version that the job states for an external model, and the version of the effects.
    ///
    /// A calibration is pinned to all three; [`equations_of`] is the part that a worker knows.
    pub fn model_version(&self, equations: &str) -> String {
        let stated = self
            .external
            .as_ref()
            .map(|model| format!("+version.{}", model.version));
        let stated = stated.unwrap_or_default();
        format!("{equations}{stated}{}", EffectSet::version(&self.effects))
    }

    /// Returns the name of the variant on the wire, by [`hash_of`].
    pub fn hash(&self) -> String {
        hash_of(&self.text())
    }

    /// Returns the JSON of the variant. Struct fields and ordered maps serialise in one order, so equal variants have
    /// equal text.
    pub fn text(&self) -> Vec<u8> {
        serde_json::to_vec(self).expect("a variant holds only numbers, text and ordered maps")
    }
}

/// Returns the hash of a variant's text: the first 128 bits of the SHA-256, in hex.
pub fn hash_of(text: &[u8]) -> String {
    let digest = Sha256::digest(text);
    digest[..16].iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns the part of a model's version that names the equations.
pub fn equations_of(version: &str) -> &str {
    version
        .split_once('+')
        .map_or(version, |(equations, _)| equations)
}

/// Checks that effects of grousers act on a wheel with grousers.
fn check_grousers(
    effects: &EffectSet,
    names: &BTreeSet<&str>,
    experiment: &Experiment,
) -> Result<(), ModelError> {
    let wheels = experiment.wheel_names();
    let uses_grousers = |effect: &&Effect| {
        let uses = effect.uses();
        uses.contains(Variable::GrouserCount) || uses.contains(Variable::GrouserHeight)
    };
    for effect in effects.iter().filter(uses_grousers) {
        let reach = EffectSet::acts_on(effect, names, &wheels);
        let mut smooth = reach
            .iter()
            .filter(|wheel| !experiment.wheels[**wheel].has_grousers());
        let all = reach.len() == wheels.len() && smooth.clone().count() < reach.len();
        if let Some(wheel) = smooth.next().filter(|_| !all) {
            return Err(ModelError::Incomplete(format!(
                "effect {} needs a wheel with grousers: {wheel} has none",
                effect.name
            )));
        }
    }
    Ok(())
}

impl Observables {
    /// Returns whether every vector that a variant requests has an entry for each condition, transient, plate and ring; vectors beyond
    /// the request are allowed.
    pub fn covers(&self, variant: &ModelVariant) -> bool {
        let runs = variant.conditions.len();
        let derivatives = if variant.stiffness_sensitivity { runs } else { 0 };
        let all = variant.channels.is_empty();
        let is_requested = |channel: &Channel| all || variant.channels.contains(channel);
        let fits = |len: usize, full: usize, is_requested: bool| len == full || (len == 0 && !is_requested);
        let histories = if variant.histories { runs } else { 0 };
        let whole = |history: &SimulatedHistory| {
            let samples = history.sinkage_m.len();
            Channel::ALL.iter().all(|&c| history.channel(c).len() == samples)
        };
        self.transient_sinkage_m.len() == variant.transient_points()
            && self.plate_pressure_pa.len() == variant.plates.len()
            && self.shear_stress_pa.len() == variant.rings.len()
            && self.histories.len() == histories
            && self.histories.iter().all(whole)
            && Channel::ALL.iter().all(|c| {
                fits(self.sensitivity(*c).len(), derivatives, is_requested(c))
                    && fits(self.channel(*c).len(), runs, is_requested(c))
            })
            && [
                &self.b_eff_m,
                &self.contact_length_m,
                &self.residual_load_n,
                &self.simulated_travel_m,
            ]
            .iter()
            .all(|v| fits(v.len(), runs, all))
            && fits(self.nodes_in_contact.len(), runs, all)
            && (self.settled_to.is_empty() || self.settled_to.len() == runs)
    }
}
