//! Data channel: a channel of the likelihood with its name and the unit in which it is shown.

use job::{PLATE, RING, TRANSIENT};
use shared::channel::Channel;

use super::number;

/// A channel of the likelihood.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum DataChannel {
    /// A channel of the rolling wheel.
    Wheel(Channel),
    /// The readings of a bevameter test, which enter by their natural logarithm.
    Bevameter(BevameterTest),
    /// A channel of the wheel before it is steady.
    Transient(TransientChannel),
}

/// A channel of the wheel before it is steady.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum TransientChannel {
    /// The sinkage at points of the travel.
    #[serde(rename = "transient_sinkage")]
    Sinkage,
}

/// A test of the bevameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BevameterTest {
    /// Plates pressed into the soil.
    Plates,
    /// Rings sheared on the soil.
    Rings,
}

/// The unit in which values are shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShownUnit {
    /// Shown value over SI value.
    pub factor: f64,
    /// Name of the unit.
    pub name: &'static str,
}

impl BevameterTest {
    /// Returns the name in tables.
    pub fn name(self) -> &'static str {
        match self {
            BevameterTest::Plates => "plates",
            BevameterTest::Rings => "rings",
        }
    }
}

impl DataChannel {
    /// Returns the channel of an index of the likelihood.
    pub fn from_index(index: usize) -> Self {
        match index {
            PLATE => DataChannel::Bevameter(BevameterTest::Plates),
            RING => DataChannel::Bevameter(BevameterTest::Rings),
            TRANSIENT => DataChannel::Transient(TransientChannel::Sinkage),
            wheel => DataChannel::Wheel(Channel::ALL[wheel]),
        }
    }

    /// Returns the name in tables: `drawbar_pull`, `plates`.
    pub fn name(self) -> &'static str {
        match self {
            DataChannel::Wheel(channel) => channel.name(),
            DataChannel::Bevameter(test) => test.name(),
            DataChannel::Transient(TransientChannel::Sinkage) => "transient_sinkage",
        }
    }

    /// Returns the name for sentences: `drawbar pull`, `plates`.
    pub fn words(self) -> &'static str {
        match self {
            DataChannel::Wheel(channel) => channel.words(),
            DataChannel::Bevameter(test) => test.name(),
            DataChannel::Transient(TransientChannel::Sinkage) => "transient sinkage",
        }
    }

    /// Returns the SI unit.
    pub fn si_unit(self) -> &'static str {
        match self {
            DataChannel::Wheel(channel) => channel.unit(),
            DataChannel::Bevameter(_) => "1",
            DataChannel::Transient(TransientChannel::Sinkage) => Channel::Sinkage.unit(),
        }
    }

    /// Returns the unit in which values are shown; stresses are shown in percent.
    pub fn shown(self) -> ShownUnit {
        match self {
            DataChannel::Wheel(channel) => ShownUnit::new(channel),
            DataChannel::Transient(TransientChannel::Sinkage) => ShownUnit::new(Channel::Sinkage),
            DataChannel::Bevameter(_) => ShownUnit {
                factor: 100.0,
                name: "%",
            },
        }
    }
}

impl ShownUnit {
    /// Returns the unit in which a channel of the wheel is shown: sinkage in millimetres, all other channels in SI.
    pub fn new(channel: Channel) -> Self {
        let (factor, name) = match channel {
            Channel::Sinkage => (1000.0, "mm"),
            other => (1.0, other.unit()),
        };
        ShownUnit { factor, name }
    }

    /// Formats a size with two digits: `20 N m`, `0.58 mm`, `12 %`.
    pub fn size(self, si: f64) -> String {
        format!("{} {}", number::significant(self.factor * si, 2), self.name)
    }
}

/// Returns a short name for a narrow column: `pull`.
pub fn short_name(channel: Channel) -> &'static str {
    match channel {
        Channel::DrawbarPull => "pull",
        Channel::Torque => "torque",
        Channel::Sinkage => "sinkage",
        Channel::LateralForce => "lateral",
    }
}
