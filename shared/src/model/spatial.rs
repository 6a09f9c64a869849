//! Settings of the three-dimensional model: grid spacing, variants of the laws, end of a steady run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::error::ModelError;
use crate::experiment::{AveragingProtocol, ProtocolKind};
use crate::keys::keys_of;
use crate::limit;
use crate::toml_message::plain;

/// Length of a simulated run of the `paper` protocol `[s]`.
pub const PAPER_DURATION_S: f64 = 50.0;
/// Sampling rate of a history \[Hz\].
const SAMPLES_HZ: f64 = 10.0;

/// Settings of `kind = "scm"`: keys of the table `[model]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SpatialSettings {
    /// Spacing of the terrain's nodes `[m]`; finer along travel if the contact is shorter than eight nodes.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub dem_spacing_m: f64,
    /// Travel of one step `[m]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub travel_step_m: f64,
    /// The frame in which the displacement of `janosi_hanamoto` is stored.
    pub displacement: DisplacementFrame,
    /// The normal along which the pressure acts.
    pub pressure_direction: PressureAxis,
    /// The effective width that applies to the nodes of a footprint.
    pub footprint: FootprintWidth,
    /// The motion of the hub in height.
    pub vertical: HubMotion,
    /// Damping of a freely moving hub \[N s/m\].
    #[schemars(range(min = 0))]
    pub damping_n_s_m: f64,
    /// Remaining relative change of a steady run's averages towards their limit at which the run ends `[–]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub steady_tolerance: f64,
    /// Travel at which a steady run ends in any case `[m]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub steady_travel_m: f64,
}

/// The frame in which the shear displacement is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DisplacementFrame {
    /// On the wheel's rim, as in the published values of K.
    Rim,
    /// On the nodes of the soil.
    Node,
}

/// The normal along which the pressure acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PressureAxis {
    /// The normal of the wheel's surface.
    WheelNormal,
    /// The normal of the undisturbed soil: upwards, without compaction resistance.
    Vertical,
}

/// The effective width `b_eff` that applies to the nodes of a footprint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FootprintWidth {
    /// The width of the whole footprint, by its hull.
    Hull,
    /// The width of each patch of connected nodes, by the patch's contour.
    Patches,
}

/// The motion of the hub in height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HubMotion {
    /// The hub is in balance with the load at every step.
    Balance,
    /// The hub moves with the mass of the load and a damper.
    Dynamic,
}

impl Default for SpatialSettings {
    fn default() -> Self {
        SpatialSettings {
            dem_spacing_m: 0.004,
            travel_step_m: 0.0005,
            displacement: DisplacementFrame::Rim,
            pressure_direction: PressureAxis::WheelNormal,
            footprint: FootprintWidth::Hull,
            vertical: HubMotion::Balance,
            damping_n_s_m: 2000.0,
            steady_tolerance: 0.005,
            steady_travel_m: 1.0,
        }
    }
}

impl SpatialSettings {
    /// Returns the names of the keys.
    pub fn keys() -> &'static [&'static str] {
        keys_of::<Self>()
    }

    /// Reads the keys in `[model]`; [`ModelError`] names the key, the value and the allowed values.
    pub fn from_table(table: toml::Table) -> Result<Self, ModelError> {
        let damped = table.contains_key("damping_n_s_m");
        let settings: SpatialSettings = table
            .try_into()
            .map_err(|e: toml::de::Error| ModelError::Invalid(plain("", None, &e.to_string())))?;
        for (key, value, unit) in [
            ("dem_spacing_m", settings.dem_spacing_m, " m"),
            ("travel_step_m", settings.travel_step_m, " m"),
            ("steady_tolerance", settings.steady_tolerance, ""),
            ("steady_travel_m", settings.steady_travel_m, " m"),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(ModelError::Invalid(format!(
                    "{key} {value}{unit} must be > 0{unit}"
                )));
            }
            if let Some(why) = limit::impossible(key, value) {
                return Err(ModelError::Invalid(format!("{key} {why}")));
            }
        }
        if damped && settings.vertical == HubMotion::Balance {
            let message = "damping_n_s_m has no effect without vertical = \"dynamic\"";
            return Err(ModelError::Inexpressible(message.to_owned()));
        }
        let damping = settings.damping_n_s_m;
        if !(damping.is_finite() && damping >= 0.0) {
            return Err(ModelError::Invalid(format!(
                "damping_n_s_m {damping} N s/m must be >= 0 N s/m"
            )));
        }
        Ok(settings)
    }

    /// Checks that a run can follow a protocol with these settings, and that each setting has an effect. [`ModelError`]
    /// names the key, the value and the allowed values.
    pub fn check_protocol(&self, protocol: &AveragingProtocol) -> Result<(), ModelError> {
        if protocol.kind == ProtocolKind::Steady {
            return Ok(());
        }
        let default = SpatialSettings::default();
        for (key, value, default) in [
            (
                "steady_tolerance",
                self.steady_tolerance,
                default.steady_tolerance,
            ),
            ("steady_travel_m", self.steady_travel_m, default.steady_travel_m),
        ] {
            if value.to_bits() != default.to_bits() {
                return Err(ModelError::Invalid(format!(
                    "{key} has no effect with [protocol] kind = \"paper\""
                )));
            }
        }
        for (key, value) in [
            (
                "simulated_transient_force_s",
                protocol.simulated_transient_force_s,
            ),
            (
                "simulated_transient_sinkage_s",
                protocol.simulated_transient_sinkage_s,
            ),
        ] {
            if value >= PAPER_DURATION_S {
                return Err(ModelError::Invalid(format!(
                    "[protocol] {key} {value} s must be < {PAPER_DURATION_S} s, the length of the simulated run"
                )));
            }
        }
        let lowpass = protocol.lowpass_hz;
        if lowpass >= 0.5 * SAMPLES_HZ {
            return Err(ModelError::Invalid(format!(
                "[protocol] lowpass_hz {lowpass} Hz must be < {} Hz, half of the {SAMPLES_HZ} samples a second",
                0.5 * SAMPLES_HZ
            )));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEGATIVE: &str = "vertical = \"dynamic\"\ndamping_n_s_m = -1.0";

    fn read(text: &str) -> Result<SpatialSettings, ModelError> {
        SpatialSettings::from_table(toml::from_str(text).unwrap())
    }

    #[test]
    fn values_out_of_bounds_and_unknown_words_are_named() {
        for (text, message) in [
            ("dem_spacing_m = 0.0", "dem_spacing_m 0 m must be > 0 m"),
            (NEGATIVE, "damping_n_s_m -1 N s/m must be >= 0 N s/m"),
            (
                "damping_n_s_m = 1.0",
                "damping_n_s_m has no effect without vertical = \"dynamic\"",
            ),
        ] {
            assert_eq!(read(text).unwrap_err().to_string(), message);
        }
        for (text, words) in [
            ("displacement = \"soil\"", ["soil", "rim", "node"]),
            ("footprint = \"contour\"", ["contour", "hull", "patches"]),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(words.into_iter().all(|word| error.contains(word)), "{error}");
        }
    }

    #[test]
    fn a_protocol_that_no_run_can_follow_is_refused() {
        let refused = |change: fn(&mut SpatialSettings, &mut AveragingProtocol)| {
            let (mut settings, mut protocol) = (SpatialSettings::default(), AveragingProtocol::default());
            protocol.kind = ProtocolKind::Paper;
            settings.check_protocol(&protocol).unwrap();
            change(&mut settings, &mut protocol);
            settings.check_protocol(&protocol).unwrap_err().to_string()
        };
        assert_eq!(
            refused(|_, protocol| protocol.simulated_transient_force_s = 50.0),
            "[protocol] simulated_transient_force_s 50 s must be < 50 s, the length of the simulated run"
        );
        assert_eq!(
            refused(|_, protocol| protocol.lowpass_hz = 5.0),
            "[protocol] lowpass_hz 5 Hz must be < 5 Hz, half of the 10 samples a second"
        );
        assert_eq!(
            refused(|settings, _| settings.steady_travel_m = 2.0),
            "steady_travel_m has no effect with [protocol] kind = \"paper\""
        );
    }
}
