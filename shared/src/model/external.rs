//! A model that is not ours: a program or a UM-Bridge server, with what it takes and what it gives.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::channel::Channel;
use crate::parameters::{BASE, BaseParameter, ParameterBounds};

/// A model that is not ours, as a job describes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ExternalModel {
    /// Where it is.
    pub source: ExternalSource,
    /// The version that the job states of it.
    pub version: String,
    /// The properties of a run that it takes, in its order.
    pub inputs: Vec<RunInput>,
    /// The parameters that it takes, in its order.
    pub parameters: Vec<ExternalParameter>,
    /// The channels that it gives, in its order.
    #[schema(value_type = Vec<String>)]
    pub outputs: Vec<Channel>,
    /// The longest that one run may take `[s]`.
    pub time_s: f64,
    /// Address space of a program \[MB\]; absent of a server, which has its own limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_mb: Option<u64>,
}

/// Where a model that is not ours is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ExternalSource {
    /// A program of a worker's machine.
    Command {
        /// Name of its file, without a folder: where it lies is its operator's choice.
        program: String,
    },
    /// A model of a UM-Bridge server.
    Umbridge {
        /// URL of the server.
        url: String,
        /// Name of the model there.
        model: String,
    },
}

impl ExternalSource {
    /// The name by which workers say that they run it: `wheel.py`, or `http://host:4242 wheel`.
    pub fn name(&self) -> String {
        match self {
            ExternalSource::Command { program } => program.clone(),
            ExternalSource::Umbridge { url, model } => format!("{url} {model}"),
        }
    }
}

/// A parameter of a model that is not ours.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ExternalParameter {
    /// Its name.
    pub name: String,
    /// Its unit; `1` without one.
    pub unit: String,
}

impl ExternalParameter {
    /// Reads `NAME` of a parameter that our models have too, or `NAME [UNIT]`; `None` where the unit is missing.
    pub(super) fn read(text: &str) -> Option<Self> {
        let (name, unit) = match text.split_once('[') {
            Some((name, unit)) => (name.trim(), unit.trim().strip_suffix(']')?.trim()),
            None => (text.trim(), known(text.trim())?.unit),
        };
        Some(ExternalParameter {
            name: name.to_owned(),
            unit: unit.to_owned(),
        })
    }

    /// The parameter of our models that has the same name.
    pub fn known(&self) -> Option<&'static BaseParameter> {
        known(&self.name)
    }

    /// Unit and bounds: those of ours of the same name and unit; otherwise none but the job's are known.
    pub fn bounds(&self) -> ParameterBounds {
        let unbounded = ParameterBounds {
            unit: self.unit.clone(),
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
        };
        let same = self.known().filter(|known| known.unit == self.unit);
        same.map_or(unbounded, ParameterBounds::from)
    }
}

fn known(name: &str) -> Option<&'static BaseParameter> {
    BASE.iter().find(|base| base.name == name)
}

/// A property of a run that a model takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum RunInput {
    /// Slip by the rig's radius, in [-1, 1).
    Slip,
    /// Vertical load `[N]`.
    WheelLoadN,
    /// Sled speed along travel `[m/s]`.
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
    GravityMS2,
}

impl RunInput {
    /// Every property.
    pub const ALL: [RunInput; 12] = [
        RunInput::Slip,
        RunInput::WheelLoadN,
        RunInput::SledSpeedMS,
        RunInput::AngularVelocityRadS,
        RunInput::SlipAngleDeg,
        RunInput::Pass,
        RunInput::RadiusM,
        RunInput::WidthM,
        RunInput::GrouserCount,
        RunInput::GrouserHeightM,
        RunInput::GrouserThicknessM,
        RunInput::GravityMS2,
    ];

    /// Name in jobs and in what a program reads.
    pub fn name(self) -> &'static str {
        [
            "slip",
            "wheel_load_n",
            "sled_speed_m_s",
            "angular_velocity_rad_s",
            "slip_angle_deg",
            "pass",
            "radius_m",
            "width_m",
            "grouser_count",
            "grouser_height_m",
            "grouser_thickness_m",
            "gravity_m_s2",
        ][self as usize]
    }
}

impl ExternalModel {
    /// The parameter of a name.
    pub fn parameter(&self, name: &str) -> Option<&ExternalParameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// Whether it has a parameter of our models, in the same unit.
    pub fn shares(&self, name: &str) -> bool {
        let same = |own: &ExternalParameter| own.known().is_some_and(|known| known.unit == own.unit);
        self.parameter(name).is_some_and(same)
    }

    /// Whether it takes a property of a run.
    pub fn takes(&self, input: RunInput) -> bool {
        self.inputs.contains(&input)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_of_its_own_brings_its_unit_and_a_known_one_has_it() {
        let read = |text: &str| ExternalParameter::read(text).map(|p| (p.name, p.unit));
        let own = |name: &str, unit: &str| Some((name.to_owned(), unit.to_owned()));
        assert_eq!(read("n"), own("n", "1"));
        assert_eq!(read("contact_stiffness [N/m]"), own("contact_stiffness", "N/m"));
        assert_eq!(read("contact_stiffness"), None);
        assert_eq!(read("contact_stiffness [N/m"), None);
    }

    #[test]
    fn the_bounds_of_a_known_name_hold_in_its_own_unit_alone() {
        let bounds = |text: &str| ExternalParameter::read(text).unwrap().bounds();
        assert!(bounds("cohesion_pa").lower.abs() < f64::EPSILON);
        assert!(bounds("cohesion_pa [kPa]").lower.is_infinite());
    }
}
