//! Settings of the model that are candidates of a search, as effects are.

use shared::model::ModelKind;
use shared::model::spatial::{DisplacementFrame, PressureAxis};

use crate::spec::Spec;

/// A setting of the model that a search may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModelSwitch {
    /// Name of the candidate.
    pub name: &'static str,
    /// Key under `[model]`.
    pub key: &'static str,
    /// The value of the key.
    pub value: &'static str,
    /// A sentence that states the assumption of the model with this setting.
    pub summary: &'static str,
}

/// The settings that a search may change.
pub const MODEL_SWITCHES: [ModelSwitch; 6] = [
    ModelSwitch {
        name: "pressure_direction_vertical",
        key: "pressure_direction",
        value: "vertical",
        summary: "the pressure acts upwards: the soil does not resist compaction",
    },
    ModelSwitch {
        name: "pressure_direction_wheel_normal",
        key: "pressure_direction",
        value: "wheel_normal",
        summary: "the pressure acts along the normal of the rim: the soil resists compaction",
    },
    ModelSwitch {
        name: "displacement_node",
        key: "displacement",
        value: "node",
        summary: "the shear displacement belongs to the soil that is sheared",
    },
    ModelSwitch {
        name: "displacement_rim",
        key: "displacement",
        value: "rim",
        summary: "the shear displacement belongs to the point of the rim",
    },
    ModelSwitch {
        name: "kind_scm",
        key: "kind",
        value: "scm",
        summary: "the soil is a terrain in three dimensions that keeps its deformation",
    },
    ModelSwitch {
        name: "kind_quasi_static",
        key: "kind",
        value: "quasi_static",
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

    /// Returns whether it is the default of `scm`.
    pub fn is_usual(&self) -> bool {
        matches!(self.name, "pressure_direction_wheel_normal" | "displacement_rim")
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
            _ => spec.model.kind == ModelKind::QuasiStatic,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::model::ModelSettings;

    #[test]
    fn every_switch_is_a_setting_of_its_model() {
        for switch in MODEL_SWITCHES {
            let text = match switch.key {
                "kind" => format!("kind = \"{}\"", switch.value),
                key => format!("kind = \"scm\"\n{key} = \"{}\"", switch.value),
            };
            ModelSettings::from_table(&text.parse().unwrap()).unwrap();
        }
    }
}
