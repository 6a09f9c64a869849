//! Settings of the model that are candidates of a search, as effects are.

use formula::Variable;
use shared::model::spatial::{DisplacementFrame, PressureAxis};
use shared::model::{EffectSet, ModelKind};

use crate::plain_parameter::{PLAIN_PARAMETERS, PlainParameter};
use crate::spec::Spec;

/// A setting of the model that a search may change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelSwitch {
    /// Name of the candidate.
    pub name: &'static str,
    /// Key under `[model]`.
    pub key: &'static str,
    /// The value of the key.
    pub value: SettingValue,
    /// A sentence that states the assumption of the model with this setting.
    pub summary: &'static str,
}

/// The value of a setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SettingValue {
    /// One of the words that the key takes.
    Word(&'static str),
    /// The limit of a parameter, which no prior of a candidate reaches.
    Limit(f64),
}

impl From<SettingValue> for toml::Value {
    fn from(value: SettingValue) -> Self {
        match value {
            SettingValue::Word(word) => word.into(),
            SettingValue::Limit(number) => number.into(),
        }
    }
}

/// The reference velocity of the shear law.
const SHEAR_VELOCITY: &str = "shear_velocity_m_s";

/// The settings that a search may change.
///
/// Only the reference velocity has a limit here: the effect `shear_velocity_scale` multiplies it by a positive factor. The priors of the
/// other [plain parameters](crate::PLAIN_PARAMETERS) include the ends of their ranges, and an infinite elastic stiffness is no value of the
/// model.
pub const MODEL_SWITCHES: [ModelSwitch; 7] = [
    ModelSwitch {
        name: "pressure_direction_vertical",
        key: "pressure_direction",
        value: SettingValue::Word("vertical"),
        summary: "the pressure acts upwards: the soil does not resist compaction",
    },
    ModelSwitch {
        name: "pressure_direction_wheel_normal",
        key: "pressure_direction",
        value: SettingValue::Word("wheel_normal"),
        summary: "the pressure acts along the normal of the rim: the soil resists compaction",
    },
    ModelSwitch {
        name: "displacement_node",
        key: "displacement",
        value: SettingValue::Word("node"),
        summary: "the shear displacement belongs to the soil that is sheared",
    },
    ModelSwitch {
        name: "displacement_rim",
        key: "displacement",
        value: SettingValue::Word("rim"),
        summary: "the shear displacement belongs to the point of the rim",
    },
    ModelSwitch {
        name: "shear_velocity_zero",
        key: SHEAR_VELOCITY,
        value: SettingValue::Limit(0.0),
        summary: "the shear stress does not depend on the slip velocity",
    },
    ModelSwitch {
        name: "kind_scm",
        key: "kind",
        value: SettingValue::Word("scm"),
        summary: "the soil is a terrain in three dimensions that keeps its deformation",
    },
    ModelSwitch {
        name: "kind_quasi_static",
        key: "kind",
        value: SettingValue::Word("quasi_static"),
        summary: "the wheel is a smooth cylinder in balance on undisturbed soil",
    },
];

impl ModelSwitch {
    /// Returns the setting of a candidate's name.
    pub fn find(name: &str) -> Option<&'static Self> {
        MODEL_SWITCHES.iter().find(|switch| switch.name == name)
    }

    /// Returns whether it replaces the forward model.
    pub fn is_kind(&self) -> bool {
        self.key == "kind"
    }

    /// Returns the candidate whose parameter has its limit at the setting.
    pub fn limit_of(&self) -> Option<&'static str> {
        match self.value {
            SettingValue::Word(_) => None,
            SettingValue::Limit(_) => PlainParameter::find(self.key).map(PlainParameter::candidate),
        }
    }

    /// Returns the line of the model's table that makes the setting: `displacement = "node"`.
    pub fn line(&self) -> String {
        format!("{} = {}", self.key, toml::Value::from(self.value))
    }

    /// Returns whether it is the default of a kind of model.
    pub fn is_default(&self, kind: ModelKind) -> bool {
        match self.value {
            SettingValue::Word(_) => {
                matches!(self.name, "pressure_direction_wheel_normal" | "displacement_rim")
            }
            SettingValue::Limit(limit) => kind
                .parameters()
                .any(|p| p.name == self.key && p.default == Some(limit)),
        }
    }

    /// Returns whether a job has the setting.
    pub fn is_on(&self, spec: &Spec) -> bool {
        let spatial = spec.model.spatial.as_ref();
        let displacement = spatial.map(|s| s.displacement);
        let direction = spatial.map(|s| s.pressure_direction);
        match self.name {
            "pressure_direction_vertical" => direction == Some(PressureAxis::Vertical),
            "pressure_direction_wheel_normal" => direction == Some(PressureAxis::WheelNormal),
            "displacement_node" => displacement == Some(DisplacementFrame::Node),
            "displacement_rim" => displacement == Some(DisplacementFrame::Rim),
            "kind_scm" => spec.model.kind == ModelKind::Scm,
            "kind_quasi_static" => spec.model.kind == ModelKind::QuasiStatic,
            _ => matches!(self.value, SettingValue::Limit(limit) if held(spec, self.key) == Some(limit)),
        }
    }

    /// Returns whether a search has it as a candidate: the job does not have the setting yet, and may have it.
    pub fn is_candidate(&self, spec: &Spec) -> bool {
        let may_turn = match self.value {
            SettingValue::Word(_) => !self.is_kind() || spec.discovery.other_kind,
            // Plates have no slip velocity, and an effect that reads the parameter has no meaning at its limit.
            SettingValue::Limit(_) => {
                let effects = EffectSet::read(&spec.fit_variant.effects);
                held(spec, self.key).is_some()
                    && !spec.fit_variant.conditions.is_empty()
                    && effects.is_ok_and(|effects| effects.using(Variable::ShearVelocity).is_none())
            }
        };
        may_turn && !self.is_on(spec)
    }
}

impl Spec {
    /// Returns the names of the plain parameters that are free, and of the settings of the model that a search may change.
    pub fn freed(&self) -> Vec<String> {
        let free = |plain: &&PlainParameter| self.parameters.iter().any(|p| p.name == plain.name);
        let freed = PLAIN_PARAMETERS.iter().filter(free).map(|plain| plain.name);
        // Default settings are left out; the kind is stated.
        let turned = MODEL_SWITCHES.iter();
        let turned = turned.filter(|switch| switch.is_on(self) && !switch.is_default(self.model.kind));
        freed
            .chain(turned.map(|switch| switch.name))
            .map(str::to_owned)
            .collect()
    }
}

/// Returns the value at which a job holds a parameter of our models; `None` if it is free or if the model has no such parameter.
fn held(spec: &Spec, name: &str) -> Option<f64> {
    let parameter = spec.model.kind.parameters().find(|p| p.name == name)?;
    let is_free = spec.parameters.iter().any(|p| p.name == name);
    let stated = spec.model.fixed.get(name).copied();
    stated.or(parameter.default).filter(|_| !is_free)
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::model::ModelSettings;

    #[test]
    fn every_switch_is_a_setting_of_its_model() {
        for switch in MODEL_SWITCHES {
            let text = match switch.key {
                "kind" => switch.line(),
                _ => format!("kind = \"scm\"\n{}", switch.line()),
            };
            ModelSettings::from_table(&text.parse().unwrap()).unwrap();
        }
    }
}
