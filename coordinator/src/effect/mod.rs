//! The effects as users meet them: what the catalogue has of each, and what each does.
//!
//! # Layout
//! - here: [`EffectCard`], an effect in words and numbers.
//! - [`library`]: laws that joined the library, and the studies that tried them.
//! - [`signature`]: what it changes in what a rig measures, as a worker computes it.

pub mod library;
pub mod signature;

use formula::effect::Mechanism;
use formula::{Effect, Hook, Parameter};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// An effect in words and numbers.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct EffectCard {
    /// Name in jobs and results.
    pub name: String,
    /// Location of the file.
    pub origin: Origin,
    /// Version of the file, from 1; null of the library's, which come with the program.
    pub version: Option<i64>,
    /// The effect in a line.
    pub summary: String,
    /// Publication or data that the effect comes from.
    pub source: String,
    /// The part of the model that it concerns: `pressure`, `shear`, `wheel` or `rig`.
    pub group: Group,
    /// Quantities that its formulas replace, in the order of evaluation.
    pub hooks: Vec<String>,
    /// The mechanism that a model may have in code, in place of the formulas.
    pub mechanism: Option<String>,
    /// Parameters, in the order of the file.
    pub parameters: Vec<ParameterCard>,
}

/// The location of an effect's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// The library that comes with the program.
    Library,
    /// The store of a service, to which a user has added it.
    Own,
}

/// A parameter of an effect.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct ParameterCard {
    /// Name within the effect; `EFFECT.NAME` in jobs.
    pub name: String,
    /// Unit of the parameter.
    pub unit: String,
    /// The value at which the effect is absent; null for a parameter that only shapes it.
    pub neutral: Option<f64>,
    /// The value at which tables show the effect; null for a shape.
    pub typical: Option<f64>,
    /// Prior of the parameter as in `[priors]`: a number, which fixes the parameter, or a distribution.
    #[schema(value_type = Value)]
    pub prior: serde_json::Value,
}

/// The part of the model that an effect concerns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// The pressure under the wheel.
    Pressure,
    /// The resistance of the soil to sliding.
    Shear,
    /// Shape, motion and load of the wheel.
    Wheel,
    /// Forces beside the contact, and errors of the instruments.
    Rig,
}

impl Group {
    /// All groups, in the order of lists.
    pub const ALL: [Group; 4] = [Group::Pressure, Group::Shear, Group::Wheel, Group::Rig];

    /// Returns the title in lists.
    pub fn title(self) -> &'static str {
        match self {
            Group::Pressure => "How the soil carries the wheel",
            Group::Shear => "How the soil resists sliding",
            Group::Wheel => "Shape, motion and load of the wheel",
            Group::Rig => "Forces and readings beside the contact",
        }
    }

    fn new(effect: &Effect) -> Group {
        if let Some(mechanism) = effect.mechanism {
            return match mechanism {
                Mechanism::FlatPatch => Group::Wheel,
                Mechanism::SideWall => Group::Rig,
                Mechanism::Rebound | Mechanism::Digging | Mechanism::EndWall => Group::Pressure,
            };
        }
        match effect.hooks().max_by_key(|hook| match hook {
            Hook::SinkageExponent | Hook::Pressure => 3,
            Hook::ShearLimit | Hook::Shear => 2,
            Hook::Slip | Hook::Radius | Hook::Width | Hook::WheelLoad => 1,
            Hook::DrawbarPull | Hook::Torque | Hook::Sinkage | Hook::LateralForce => 0,
        }) {
            Some(Hook::SinkageExponent | Hook::Pressure) => Group::Pressure,
            Some(Hook::ShearLimit | Hook::Shear) => Group::Shear,
            Some(Hook::Slip | Hook::Radius | Hook::Width | Hook::WheelLoad) => Group::Wheel,
            Some(Hook::DrawbarPull | Hook::Torque | Hook::Sinkage | Hook::LateralForce) | None => Group::Rig,
        }
    }
}

impl EffectCard {
    /// Returns the card of an effect of the library.
    pub fn new(effect: &Effect) -> Self {
        EffectCard {
            name: effect.name.clone(),
            origin: Origin::Library,
            version: None,
            summary: effect.summary.clone(),
            source: effect.source.clone(),
            group: Group::new(effect),
            hooks: effect.hooks().map(|hook| hook.name().to_owned()).collect(),
            mechanism: effect.mechanism.map(|m| m.name().to_owned()),
            parameters: effect.parameters.iter().map(ParameterCard::new).collect(),
        }
    }

    /// Returns the card of a version of an effect that a user has added.
    pub fn user(effect: &Effect, version: i64) -> Self {
        EffectCard {
            origin: Origin::Own,
            version: Some(version),
            ..EffectCard::new(effect)
        }
    }

    /// Returns the hooks or the mechanism by which it enters the model.
    pub fn enters(&self) -> String {
        let hooks = self.hooks.join(", ");
        match (&self.mechanism, hooks.as_str()) {
            (None, hooks) => hooks.to_owned(),
            (Some(mechanism), "") => format!("mechanism {mechanism}"),
            (Some(mechanism), hooks) => format!("mechanism {mechanism} of a model that has it, or {hooks}"),
        }
    }
}

impl ParameterCard {
    fn new(parameter: &Parameter) -> Self {
        ParameterCard {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
            neutral: parameter.neutral,
            typical: parameter.neutral.and(parameter.shown_at()),
            prior: serde_json::to_value(&parameter.prior).unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use formula::catalogue::catalogue;

    #[test]
    fn every_group_has_effects() {
        let cards: Vec<EffectCard> = catalogue().iter().map(EffectCard::new).collect();
        for group in Group::ALL {
            assert!(cards.iter().any(|card| card.group == group), "{group:?}");
        }
    }
}
