//! An external model: a program or a UM-Bridge server, with its inputs and outputs.

use serde::{Deserialize, Serialize};
use strum::{EnumString, IntoStaticStr, VariantArray};
use utoipa::ToSchema;

use crate::channel::Channel;
use crate::parameters::{BASE, BaseParameter, ParameterBounds};

/// An external model, as a job describes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ExternalModel {
    /// The program or server that runs it.
    pub source: ExternalSource,
    /// The version that the job states.
    pub version: String,
    /// The properties of a run that it takes, in order.
    pub inputs: Vec<RunInput>,
    /// The parameters that it takes, in order.
    pub parameters: Vec<ExternalParameter>,
    /// The channels that it returns, in order.
    #[schema(value_type = Vec<String>)]
    pub outputs: Vec<Channel>,
    /// The maximum time of one run `[s]`.
    pub time_s: f64,
    /// Maximum address space of a program \[MB\]; absent for a server, which has its own limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_mb: Option<u64>,
}

/// The location of an external model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ExternalSource {
    /// A program on a worker's machine.
    Command {
        /// Name of its file, without a folder: the operator chooses the folder.
        program: String,
    },
    /// A model on a UM-Bridge server.
    Umbridge {
        /// URL of the server.
        url: String,
        /// Name of the model on the server.
        model: String,
    },
}

impl ExternalSource {
    /// Returns the name under which workers announce it: `wheel.py`, or `http://host:4242 wheel`.
    pub fn name(&self) -> String {
        match self {
            ExternalSource::Command { program } => program.clone(),
            ExternalSource::Umbridge { url, model } => format!("{url} {model}"),
        }
    }
}

/// A parameter of an external model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ExternalParameter {
    /// Name of the parameter.
    pub name: String,
    /// Unit of the parameter; `1` if dimensionless.
    pub unit: String,
}

impl ExternalParameter {
    /// Reads `NAME` of a parameter that the built-in models have too, or `NAME [UNIT]`; `None` if the unit is missing.
    pub(super) fn read(text: &str) -> Option<Self> {
        let (name, unit) = match text.split_once('[') {
            Some((name, unit)) => (name.trim(), unit.trim().strip_suffix(']')?.trim()),
            None => (text.trim(), base_parameter(text.trim())?.unit),
        };
        Some(ExternalParameter {
            name: name.to_owned(),
            unit: unit.to_owned(),
        })
    }

    /// Returns the parameter of the built-in models with the same name.
    pub fn base_parameter(&self) -> Option<&'static BaseParameter> {
        base_parameter(&self.name)
    }

    /// Returns the unit and bounds: those of the built-in parameter of the same name and unit; otherwise unbounded.
    pub fn bounds(&self) -> ParameterBounds {
        let unbounded = ParameterBounds {
            unit: self.unit.clone(),
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
        };
        let same = self.base_parameter().filter(|base| base.unit == self.unit);
        same.map_or(unbounded, ParameterBounds::from)
    }
}

fn base_parameter(name: &str) -> Option<&'static BaseParameter> {
    BASE.iter().find(|base| base.name == name)
}

/// A property of a run that an external model can take.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    ToSchema,
    EnumString,
    IntoStaticStr,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum RunInput {
    /// Slip by the rig's radius, in [-1, 1).
    Slip,
    /// Vertical load `[N]`.
    WheelLoadN,
    /// Sled speed along travel `[m/s]`.
    #[strum(serialize = "sled_speed_m_s")]
    SledSpeedMS,
    /// Speed of the motor by the rig's radius `[rad/s]`.
    AngularVelocityRadS,
    /// From wheel heading to travel `[deg]`.
    SlipAngleDeg,
    /// Number of passes; the last one is averaged.
    Pass,
    /// Radius of the rim `[m]`.
    RadiusM,
    /// Width of the rim `[m]`.
    WidthM,
    /// Number of grousers.
    GrouserCount,
    /// Height of the grousers `[m]`.
    GrouserHeightM,
    /// Thickness of the grousers `[m]`.
    GrouserThicknessM,
    /// Acceleration of gravity `[m/s^2]`.
    #[strum(serialize = "gravity_m_s2")]
    GravityMS2,
}

impl RunInput {
    /// Every property, in the order of the enumeration.
    pub const ALL: &'static [Self] = Self::VARIANTS;

    /// Returns the name in jobs and in the input of a program.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

impl ExternalModel {
    /// Finds a parameter by name.
    pub fn parameter(&self, name: &str) -> Option<&ExternalParameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// Returns whether it has a parameter of the built-in models, in the same unit.
    pub fn shares(&self, name: &str) -> bool {
        let same = |p: &ExternalParameter| p.base_parameter().is_some_and(|base| base.unit == p.unit);
        self.parameter(name).is_some_and(same)
    }

    /// Returns whether the model takes a property of a run.
    pub fn takes(&self, input: RunInput) -> bool {
        self.inputs.contains(&input)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_parameter_states_its_unit_and_a_base_parameter_has_one() {
        let read = |text: &str| ExternalParameter::read(text).map(|p| (p.name, p.unit));
        let expected = |name: &str, unit: &str| Some((name.to_owned(), unit.to_owned()));
        assert_eq!(read("n"), expected("n", "1"));
        assert_eq!(read("stiffness [N/m]"), expected("stiffness", "N/m"));
        assert_eq!(read("stiffness"), None);
        assert_eq!(read("stiffness [N/m"), None);
    }

    #[test]
    fn the_bounds_of_a_base_parameter_hold_only_in_its_unit() {
        let bounds = |text: &str| ExternalParameter::read(text).unwrap().bounds();
        assert!(bounds("cohesion_pa").lower.abs() < f64::EPSILON);
        assert!(bounds("cohesion_pa [kPa]").lower.is_infinite());
    }
}
