//! Errors that the runs of a session, a taring or an operator share.

use super::check::{RawSharedSd, ValueError};
use super::rig_column::RigColumn;
use super::scatter::ScatterSd;
use crate::channel::Channel;

/// What the runs of one state of the rig share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RigQuantity {
    /// An offset of a measured channel.
    Offset(Channel),
    /// A relative deviation of the soil's stiffness.
    Stiffness,
}

/// An error that the runs with one id in a column share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RigError {
    /// The column of the ids.
    pub column: RigColumn,
    /// What deviates from id to id.
    pub quantity: RigQuantity,
}

const fn offset(column: RigColumn, channel: Channel) -> RigError {
    RigError {
        column,
        quantity: RigQuantity::Offset(channel),
    }
}

const fn stiffness(column: RigColumn) -> RigError {
    RigError {
        column,
        quantity: RigQuantity::Stiffness,
    }
}

impl RigError {
    /// Every error, in the order of their sds in [`super::Noise::rig`]. A taring moves the zeros of force sensors; the person who levels
    /// the bed moves its stiffness and its surface.
    pub const ALL: [RigError; 10] = [
        offset(RigColumn::Session, Channel::DrawbarPull),
        offset(RigColumn::Session, Channel::Torque),
        offset(RigColumn::Session, Channel::Sinkage),
        offset(RigColumn::Session, Channel::LateralForce),
        stiffness(RigColumn::Session),
        offset(RigColumn::Zero, Channel::DrawbarPull),
        offset(RigColumn::Zero, Channel::Torque),
        offset(RigColumn::Zero, Channel::LateralForce),
        offset(RigColumn::Operator, Channel::Sinkage),
        stiffness(RigColumn::Operator),
    ];

    /// Returns the key under `[noise]`, and in the parameter's name: `session_sinkage_m`.
    pub fn key(self) -> String {
        let column = self.column.name();
        match self.quantity {
            RigQuantity::Offset(channel) => format!("{column}_{}", channel.column()),
            RigQuantity::Stiffness => format!("{column}_stiffness"),
        }
    }

    /// Returns the error of a key.
    pub fn find(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|error| error.key() == key)
    }

    /// Returns the unit of the sd.
    pub fn unit(self) -> &'static str {
        match self.quantity {
            RigQuantity::Offset(channel) => channel.unit(),
            RigQuantity::Stiffness => "1",
        }
    }

    /// Returns the scale of the half-normal prior of an unknown sd, in its unit, if the job states none: the wander of the zeros of
    /// single-wheel rigs, 1 N, 0.1 N m, 0.5 mm, 1 N, and 0.1 of the stiffness.
    pub fn prior_scale(self) -> f64 {
        match self.quantity {
            RigQuantity::Offset(Channel::DrawbarPull | Channel::LateralForce) => 1.0,
            RigQuantity::Offset(Channel::Torque) => 0.1,
            RigQuantity::Offset(Channel::Sinkage) => 0.0005,
            RigQuantity::Stiffness => 0.1,
        }
    }

    /// Reads an sd; it is inferred if the experiment states none, and without the column it has no effect.
    pub(super) fn read(self, raw: Option<RawSharedSd>) -> Result<ScatterSd, ValueError> {
        let key = self.key();
        let unit = match self.unit() {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        match raw {
            None => Ok(ScatterSd::Unknown),
            Some(RawSharedSd::Word(word)) if word == "unknown" => Ok(ScatterSd::Unknown),
            Some(RawSharedSd::Word(word)) => Err(ValueError::Rule(format!(
                "{key} = \"{word}\" must be a number or \"unknown\""
            ))),
            Some(RawSharedSd::Number(sd)) if sd.is_finite() && sd >= 0.0 => Ok(ScatterSd::Known(sd)),
            Some(RawSharedSd::Number(sd)) => Err(ValueError::Rule(format!(
                "{key} {sd}{unit} must be finite and >= 0"
            ))),
        }
    }
}
