//! A quantity whose repeats are compared: a measured channel, or the load on the wheel.

use shared::channel::Channel;
use shared::experiment::TestRun;

use crate::words::data_channel::ShownUnit;

/// A quantity of a run that repeats of its condition should reproduce.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RepeatedQuantity {
    /// Load on the wheel `[N]`.
    WheelLoad,
    /// Drawbar pull `[N]`.
    DrawbarPull,
    /// Torque \[N m\].
    Torque,
    /// Sinkage `[m]`.
    Sinkage,
    /// Lateral force `[N]`.
    LateralForce,
}

impl RepeatedQuantity {
    /// Every quantity, in the order of all tables.
    pub const ALL: [RepeatedQuantity; 5] = [
        RepeatedQuantity::WheelLoad,
        RepeatedQuantity::DrawbarPull,
        RepeatedQuantity::Torque,
        RepeatedQuantity::Sinkage,
        RepeatedQuantity::LateralForce,
    ];

    /// Returns the channel; `None` for the wheel load.
    fn channel(self) -> Option<Channel> {
        match self {
            RepeatedQuantity::WheelLoad => None,
            RepeatedQuantity::DrawbarPull => Some(Channel::DrawbarPull),
            RepeatedQuantity::Torque => Some(Channel::Torque),
            RepeatedQuantity::Sinkage => Some(Channel::Sinkage),
            RepeatedQuantity::LateralForce => Some(Channel::LateralForce),
        }
    }

    /// Returns the name without unit: `wheel_load`.
    pub fn name(self) -> &'static str {
        self.channel().map_or("wheel_load", Channel::name)
    }

    /// Returns the name for sentences: `wheel load`.
    pub fn words(self) -> &'static str {
        self.channel().map_or("wheel load", Channel::words)
    }

    /// Returns the SI unit.
    pub fn unit(self) -> &'static str {
        self.channel().map_or("N", Channel::unit)
    }

    /// Returns the unit in which values are shown.
    pub fn shown(self) -> ShownUnit {
        let newton = ShownUnit {
            factor: 1.0,
            name: "N",
        };
        self.channel().map_or(newton, ShownUnit::new)
    }

    /// Returns the value of a run in SI units; `None` if it is not measured.
    pub(super) fn value(self, run: &TestRun) -> Option<f64> {
        match self.channel() {
            None => Some(run.wheel_load_n),
            Some(channel) => run.measured[channel.index()],
        }
    }
}
