//! An external model, with the effects around it.

use std::sync::Arc;

use scm::effects::Active;
use scm::outside::OutsideRun;
use scm::{Condition, Soil, Wheel};
use shared::channel::Channel;
use shared::exchange::RepeatedAnswer;
use shared::experiment::WheelGeometry;
use shared::model::{EffectSet, ExternalModel, ModelError, ModelVariant, RunInput};
use shared::outcome::{Fault, Observables, Outcome, ParameterRejection};

use super::effects::EffectMap;
use super::error::CompileError;
use super::parameters::{ParameterSource, Radius};
use crate::external::allowed::AllowedModels;
use crate::external::{ExternalFailure, ExternalRun};

/// An external model with its names resolved.
#[derive(Debug)]
pub(super) struct OutsideModel {
    description: ExternalModel,
    models: Arc<AllowedModels>,
    wheels: Vec<(WheelGeometry, Radius)>,
    conditions: Vec<(usize, Condition)>,
    effects: EffectMap,
    /// The sources of the parameters, in the model's order.
    parameters: Vec<ParameterSource>,
    shared: SharedParameters,
    gravity_m_s2: f64,
    channels: Vec<Channel>,
    /// Parameters at which the model must answer.
    probe: Vec<f64>,
    dimension: usize,
}

/// The parameters that it shares with the built-in models, which effects may use.
#[derive(Debug)]
struct SharedParameters {
    n: Option<ParameterSource>,
    cohesion_pa: Option<ParameterSource>,
    friction_angle_deg: Option<ParameterSource>,
    shear_velocity_m_s: Option<ParameterSource>,
    /// Position of n among the model's parameters.
    place_of_n: Option<usize>,
}

impl OutsideModel {
    /// Resolves the names of a variant; [`CompileError`] names what is missing or cannot be expressed.
    pub(super) fn new(
        variant: &ModelVariant,
        description: &ExternalModel,
        models: &Arc<AllowedModels>,
    ) -> Result<Self, CompileError> {
        let set = EffectSet::read(&variant.effects)?;
        variant.check_expressible(&set)?;
        if variant.histories {
            return Err(CompileError::NoHistories(variant.kind.name()));
        }
        if !variant.transients.is_empty() {
            return Err(CompileError::NoTransients(variant.kind.name()));
        }
        let find = |name: &str| ParameterSource::find(variant, name);
        let shares = |name: &str| find(name).filter(|_| description.shares(name));
        let parameters = description
            .parameters
            .iter()
            .map(|parameter| find(&parameter.name).ok_or_else(|| ModelError::Unset(parameter.name.clone())));
        let names: Vec<&String> = variant.wheels.keys().collect();
        let conditions = variant.conditions.iter().map(|c| {
            let wheel = names.iter().position(|name| **name == c.wheel);
            let wheel = wheel.ok_or_else(|| CompileError::UnknownWheel(c.wheel.clone()))?;
            Ok((wheel, super::forward::condition(c)))
        });
        let wheels = variant.wheels.iter();
        let place = |name: &str| description.parameters.iter().position(|p| p.name == name);
        Ok(OutsideModel {
            models: models.clone(),
            wheels: wheels
                .map(|(name, w)| (w.clone(), Radius::new(variant, name)))
                .collect(),
            conditions: conditions.collect::<Result<_, CompileError>>()?,
            effects: EffectMap::new(variant, &set)?,
            parameters: parameters.collect::<Result<_, ModelError>>()?,
            shared: SharedParameters {
                n: shares("n"),
                cohesion_pa: shares("cohesion_pa"),
                friction_angle_deg: shares("friction_angle_deg"),
                shear_velocity_m_s: shares("shear_velocity_m_s"),
                place_of_n: place("n").filter(|_| description.shares("n")),
            },
            gravity_m_s2: variant.gravity_m_s2,
            channels: variant.channels.clone(),
            probe: variant.probe.clone(),
            dimension: variant.parameters.len(),
            description: description.clone(),
        })
    }

    /// Returns the number of conditions of an evaluation.
    pub(super) fn runs(&self) -> usize {
        self.conditions.len()
    }

    /// Evaluates every condition at one parameter vector.
    ///
    /// If the model breaks down, it is asked at the probe: if it answers or refuses there, the parameters are at fault. If
    /// the identity of the model changes meanwhile, its answer is discarded.
    pub(super) fn evaluate(&self, theta: &[f64]) -> Outcome {
        let fault = |message: String| Outcome::Fault(Fault { message });
        let source = &self.description.source;
        let before = match self.models.announced().remove(&source.name()) {
            Some(identity) => identity,
            None => match self.models.identify(&self.description) {
                Ok(identity) => identity,
                Err(message) => return fault(message),
            },
        };
        let outcome = match self.answer(theta) {
            Ok(observables) => Outcome::Evaluated(observables),
            Err(ExternalFailure::Refused(rejection)) => Outcome::Rejected(rejection),
            Err(ExternalFailure::Machine(message)) => return fault(message),
            Err(ExternalFailure::Broke(rejection)) if theta == self.probe => {
                return fault(format!("at the medians of the priors: {}", rejection.message));
            }
            Err(ExternalFailure::Broke(rejection)) => match self.answer(&self.probe) {
                Ok(_) | Err(ExternalFailure::Refused(_)) => Outcome::Rejected(rejection),
                Err(ExternalFailure::Broke(probe)) => {
                    let also = probe.message;
                    let message = format!("{}; and at the medians of the priors: {also}", rejection.message);
                    return fault(message);
                }
                Err(ExternalFailure::Machine(message)) => return fault(message),
            },
        };
        match self.models.identify(&self.description) {
            Ok(after) if after == before => outcome,
            Ok(after) => fault(format!(
                "{} has changed: it was {before}, and is {after}",
                source.name()
            )),
            Err(message) => fault(message),
        }
    }

    /// Asks the same question again, and returns the difference of the answers; `None` if the machine fails meanwhile.
    pub(super) fn repeat(&self, theta: &[f64], first: &Observables) -> Option<RepeatedAnswer> {
        match self.answer(theta) {
            Ok(second) => Some(RepeatedAnswer::new(first, &second)),
            Err(ExternalFailure::Refused(_)) => Some(RepeatedAnswer::refused()),
            Err(ExternalFailure::Broke(_) | ExternalFailure::Machine(_)) => None,
        }
    }

    fn answer(&self, theta: &[f64]) -> Result<Observables, ExternalFailure> {
        if theta.len() != self.dimension {
            let (given, needed) = (theta.len(), self.dimension);
            let message = format!("theta has {given} entries, the variant has {needed}");
            return Err(ExternalFailure::refused("invalid_parameter", 0, message));
        }
        let refused = |run: usize, rejection: &scm::Rejection| {
            ExternalFailure::refused(rejection.kind(), run, rejection.to_string())
        };
        let mut effects = self.effects.at(theta);
        let mut given = Vec::with_capacity(self.runs());
        let mut questions = Vec::with_capacity(self.runs());
        for (position, (place, _)) in self.conditions.iter().enumerate() {
            let run = self.run(theta, position, effects.on_wheel(*place));
            let run = run.map_err(|rejection| refused(position, &rejection))?;
            questions.push(self.question(theta, *place, &run));
            given.push(run);
        }
        let answers = self.models.evaluate(&self.description, &questions)?;
        let mut observables = Observables::default();
        for (position, (run, answer)) in given.iter().zip(answers).enumerate() {
            let mut channels = [f64::NAN; 4];
            for (channel, value) in self.description.outputs.iter().zip(answer) {
                channels[channel.index()] = value;
            }
            let (place, _) = self.conditions[position];
            let measured = run.measured(effects.on_wheel(place), channels);
            let measured = measured.map_err(|rejection| refused(position, &rejection))?;
            for &channel in &self.description.outputs {
                observables.channel_mut(channel).push(measured[channel.index()]);
            }
        }
        observables.keep_only(&self.channels);
        Ok(observables)
    }

    /// Returns a run after the effects on the inputs of the model.
    fn run(&self, theta: &[f64], position: usize, effects: &Active) -> Result<OutsideRun, scm::Rejection> {
        let (place, condition) = &self.conditions[position];
        let (geometry, radius) = &self.wheels[*place];
        let wheel = Wheel {
            radius_m: radius.value(theta).unwrap_or(geometry.radius_m),
            width_m: geometry.width_m,
            rig_radius_m: geometry.rig_radius_m,
        };
        let value = |source: Option<ParameterSource>| source.map_or(f64::NAN, |s| s.value(theta));
        let soil = Soil {
            k_c: f64::NAN,
            k_phi: f64::NAN,
            n: value(self.shared.n),
            cohesion_pa: value(self.shared.cohesion_pa),
            friction_angle_rad: value(self.shared.friction_angle_deg).to_radians(),
            shear_velocity_m_s: value(self.shared.shear_velocity_m_s),
            gamma_exponent: f64::NAN,
        };
        OutsideRun::new(&soil, &wheel, condition, effects, self.effects.site(position))
    }

    /// Returns the input of the model for a run.
    fn question(&self, theta: &[f64], place: usize, run: &OutsideRun) -> ExternalRun {
        let (condition, wheel) = (run.condition(), run.wheel());
        let geometry = &self.wheels[place].0;
        let input = |input: &RunInput| match input {
            RunInput::Slip => condition.slip,
            RunInput::WheelLoadN => condition.wheel_load_n,
            RunInput::SledSpeedMS => condition.sled_speed_m_s,
            RunInput::AngularVelocityRadS => condition.rig_rim_speed_m_s() / wheel.rig_radius_m,
            RunInput::SlipAngleDeg => condition.slip_angle_rad.to_degrees(),
            RunInput::Pass => f64::from(condition.pass),
            RunInput::RadiusM => wheel.radius_m,
            RunInput::WidthM => wheel.width_m,
            RunInput::GrouserCount => f64::from(geometry.grouser_count),
            RunInput::GrouserHeightM => geometry.grouser_height_m,
            RunInput::GrouserThicknessM => geometry.grouser_thickness_m,
            RunInput::GravityMS2 => self.gravity_m_s2,
        };
        let mut parameters: Vec<f64> = self.parameters.iter().map(|s| s.value(theta)).collect();
        if let Some(place) = self.shared.place_of_n {
            parameters[place] = run.sinkage_exponent();
        }
        ExternalRun {
            inputs: self.description.inputs.iter().map(input).collect(),
            parameters,
        }
    }

    /// Returns why the conditions cannot be evaluated one by one.
    pub(super) fn no_single_runs(&self) -> ParameterRejection {
        ParameterRejection {
            kind: "not_asked".to_owned(),
            condition: 0,
            message: "a model that is not ours is asked for all conditions together".to_owned(),
        }
    }
}
