//! The channels that a test rig measures.

use serde::{Deserialize, Serialize};

/// A measured channel of a test run; also a column of `runs.csv` and of every outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// Net forward force of the wheel on the sled along the heading `[N]`, positive = the wheel pulls.
    DrawbarPull,
    /// Torque about the axle \[N m\], positive = the motor works.
    Torque,
    /// Wheel radius minus hub height above the undisturbed surface `[m]`.
    Sinkage,
    /// Force across the heading `[N]`, positive = the soil resists the motion of a positive slip angle.
    LateralForce,
}

impl Channel {
    /// Every channel, in the order of all tables and files.
    pub const ALL: [Channel; 4] = [
        Channel::DrawbarPull,
        Channel::Torque,
        Channel::Sinkage,
        Channel::LateralForce,
    ];

    /// Returns the position in [`Channel::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Returns the name without unit, as in `summary.json`: `drawbar_pull`.
    pub fn name(self) -> &'static str {
        ["drawbar_pull", "torque", "sinkage", "lateral_force"][self.index()]
    }

    /// Returns the column name with unit, as in `runs.csv`: `drawbar_pull_n`.
    pub fn column(self) -> &'static str {
        ["drawbar_pull_n", "torque_n_m", "sinkage_m", "lateral_force_n"][self.index()]
    }

    /// Returns the SI unit.
    pub fn unit(self) -> &'static str {
        ["N", "N m", "m", "N"][self.index()]
    }

    /// Returns the words for people: `drawbar pull`.
    pub fn words(self) -> &'static str {
        ["drawbar pull", "torque", "sinkage", "lateral force"][self.index()]
    }
}
