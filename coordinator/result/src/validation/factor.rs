//! A factor: the condition whose levels are left out in turn.

use shared::experiment::{TestRun, rim_speed_m_s};

use crate::words::number;

/// A factor: the condition whose levels are left out in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Factor {
    /// Slip.
    Slip,
    /// Wheel load.
    Load,
    /// Speed of the rim.
    Speed,
    /// The wheel.
    Wheel,
    /// Slip angle.
    Angle,
}

impl Factor {
    /// Returns the name on the command line and in the names of files.
    pub fn name(self) -> &'static str {
        match self {
            Factor::Slip => "slip",
            Factor::Load => "load",
            Factor::Speed => "speed",
            Factor::Wheel => "wheel",
            Factor::Angle => "angle",
        }
    }

    /// Returns the value of a run \[1, N, m/s, deg\]; `None` for the factor wheel.
    pub(super) fn value(self, run: &TestRun) -> Option<f64> {
        match self {
            Factor::Slip => Some(run.slip),
            Factor::Load => Some(run.wheel_load_n),
            Factor::Speed => Some(rim_speed_m_s(run.slip, run.sled_speed_m_s)),
            Factor::Wheel => None,
            Factor::Angle => Some(run.slip_angle_deg),
        }
    }

    /// Names a level: `slip -0.20`, `load 21.3 to 22.7 N`, `rim speed 10.0 mm/s`, `slip angle 15.0 deg`.
    pub(super) fn words(self, from: f64, to: f64) -> String {
        let (what, scale, decimals, unit) = match self {
            Factor::Slip => ("slip", 1.0, 2, ""),
            Factor::Load => ("load", 1.0, 1, " N"),
            Factor::Speed => ("rim speed", 1000.0, 1, " mm/s"),
            Factor::Wheel => ("wheel", 1.0, 0, ""),
            Factor::Angle => ("slip angle", 1.0, 1, " deg"),
        };
        let [from, to] = [from, to].map(|value| number::fixed(scale * value, decimals));
        match from == to {
            true => format!("{what} {from}{unit}"),
            false => format!("{what} {from} to {to}{unit}"),
        }
    }
}
