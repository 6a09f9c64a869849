//! The tables of `experiment.toml`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::campaign::Campaign;
use super::check::{RawScatter, RawSd, RawSharedSd, ValueError, not_negative, positive, require};
use super::rig_error::RigError;
use super::scatter::{Scatter, ScatterSd};
use super::wheel::{RawWheel, WheelGeometry};
use crate::channel::Channel;
use crate::file::{FileError, parse_toml};

/// Properties of a soil besides the calibrated parameters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SoilProperties {
    /// Bulk density `[kg/m^3]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density_kg_m3: Option<f64>,
    /// Angle of repose `[deg]`; `scm` takes 32 if it is not stated.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 90))]
    pub repose_angle_deg: Option<f64>,
}

/// The test rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rig {
    /// Acceleration of gravity `[m/s^2]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gravity_m_s2: f64,
    /// Length of the soil bin along travel `[m]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub bin_length_m: Option<f64>,
    /// Least and greatest slip that the rig can hold: proposed runs stay within.
    pub slip_range: Option<[f64; 2]>,
    /// Least and greatest wheel load that the rig can set: proposed runs stay within `[N]`.
    pub wheel_load_range_n: Option<[f64; 2]>,
    /// Least and greatest sled speed that the rig can set: proposed runs stay within `[m/s]`.
    pub sled_speed_range_m_s: Option<[f64; 2]>,
}

impl Default for Rig {
    fn default() -> Self {
        Rig {
            gravity_m_s2: 9.81,
            bin_length_m: None,
            slip_range: None,
            wheel_load_range_n: None,
            sled_speed_range_m_s: None,
        }
    }
}

/// The origin of a channel's noise standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoiseSd {
    /// A stated value [channel's unit].
    Known(f64),
    /// Pooled from the repeats of a condition.
    Replicates,
    /// A parameter of the calibration: `noise.` and the channel's column.
    Unknown,
}

/// The scatter of the measurements.
#[derive(Debug, Clone, PartialEq)]
pub struct Noise {
    /// Source of the standard deviation of each channel, in the order of [`Channel::ALL`]; `None` = not stated.
    pub sd: [Option<NoiseSd>; 4],
    /// Relative standard deviations, in the order of [`Scatter::ALL`].
    pub scatter: [ScatterSd; 7],
    /// Standard deviations of the errors of sessions, tarings and operators, in the order of [`RigError::ALL`].
    pub rig: [ScatterSd; 10],
}

impl Default for Noise {
    fn default() -> Self {
        Noise {
            sd: [None; 4],
            scatter: Scatter::ALL.map(Scatter::usual),
            rig: [ScatterSd::Unknown; 10],
        }
    }
}

impl Noise {
    /// Returns a relative standard deviation.
    pub fn scatter(&self, scatter: Scatter) -> ScatterSd {
        self.scatter[scatter.index()]
    }

    /// Returns the standard deviation of an error of the rig, in its unit.
    pub fn rig(&self, error: RigError) -> ScatterSd {
        let place = RigError::ALL.iter().position(|known| *known == error);
        self.rig[place.expect("every error is among all of them")]
    }
}

/// The protocol that turns a time history into the averages of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AveragingProtocol {
    /// The end of a simulated run.
    pub kind: ProtocolKind,
    /// Time cut from the start of a measured history `[s]`.
    #[schemars(range(min = 0))]
    pub measured_transient_s: f64,
    /// Time cut from simulated drawbar pull and torque `[s]`.
    #[schemars(range(min = 0))]
    pub simulated_transient_force_s: f64,
    /// Time cut from simulated sinkage `[s]`.
    #[schemars(range(min = 0))]
    pub simulated_transient_sinkage_s: f64,
    /// Cut-off of the zero-phase low-pass filter \[Hz\]; 0 is no filter.
    #[schemars(range(min = 0))]
    pub lowpass_hz: f64,
    /// Travel of the sled at which the slip of a measured run begins `[m]`; before it the wheel is lowered and rolls. The start of the
    /// recording, if it is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub slip_begins_m: Option<f64>,
}

/// The end of a simulated run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProtocolKind {
    /// The run ends once its averages have settled.
    Steady,
    /// After 50 s, as in the source paper.
    Paper,
}

impl Default for AveragingProtocol {
    fn default() -> Self {
        AveragingProtocol {
            kind: ProtocolKind::Steady,
            measured_transient_s: 40.0,
            simulated_transient_force_s: 20.0,
            simulated_transient_sinkage_s: 1.0,
            lowpass_hz: 0.5,
            slip_begins_m: None,
        }
    }
}

/// `experiment.toml`, validated, before the files it names are read.
pub(super) struct ExperimentFile {
    pub(super) campaign: Option<Campaign>,
    pub(super) runs: Option<String>,
    pub(super) plates: Option<String>,
    pub(super) shear: Option<String>,
    pub(super) wheel: BTreeMap<String, WheelGeometry>,
    /// Names of the mesh files, by wheel; the wheels have no mesh yet.
    pub(super) meshes: BTreeMap<String, String>,
    pub(super) soil: BTreeMap<String, SoilProperties>,
    pub(super) rig: Rig,
    pub(super) noise: Noise,
    pub(super) protocol: AveragingProtocol,
}

/// The wheels, soils, rig, noise and protocol of a campaign: the keys of `experiment.toml`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("required" = ["soil"]))]
#[schemars(extend("anyOf" = [{ "required": ["runs", "wheel"] }, { "required": ["plates"] }, { "required": ["shear"] }]))]
pub struct ExperimentKeys {
    campaign: Option<Campaign>,
    /// File of the test runs, beside the experiment.
    runs: Option<String>,
    /// File of the plate-sinkage readings.
    plates: Option<String>,
    /// File of the ring-shear readings.
    shear: Option<String>,
    /// The wheels, each as `[wheel.NAME]`.
    #[serde(default)]
    wheel: BTreeMap<String, RawWheel>,
    /// The soils, each as `[soil.NAME]`.
    #[serde(default)]
    #[schemars(extend("minProperties" = 1))]
    soil: BTreeMap<String, SoilProperties>,
    #[serde(default)]
    rig: Rig,
    #[serde(default)]
    noise: RawNoise,
    #[serde(default)]
    protocol: AveragingProtocol,
}

/// The scatter of the measurements.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RawNoise {
    /// Standard deviation of the drawbar pull `[N]`.
    drawbar_pull_n: Option<RawSd>,
    /// Standard deviation of the torque \[N m\].
    torque_n_m: Option<RawSd>,
    /// Standard deviation of the sinkage `[m]`.
    sinkage_m: Option<RawSd>,
    /// Standard deviation of the lateral force `[N]`.
    lateral_force_n: Option<RawSd>,
    run_scatter: Option<RawScatter>,
    preparation_scatter: Option<RawScatter>,
    preparation_strength_scatter: Option<RawScatter>,
    plate_scatter: Option<RawScatter>,
    plate_noise: Option<RawScatter>,
    ring_scatter: Option<RawScatter>,
    ring_noise: Option<RawScatter>,
    session_drawbar_pull_n: Option<RawSharedSd>,
    session_torque_n_m: Option<RawSharedSd>,
    session_sinkage_m: Option<RawSharedSd>,
    session_lateral_force_n: Option<RawSharedSd>,
    session_stiffness: Option<RawSharedSd>,
    zero_drawbar_pull_n: Option<RawSharedSd>,
    zero_torque_n_m: Option<RawSharedSd>,
    zero_lateral_force_n: Option<RawSharedSd>,
    operator_sinkage_m: Option<RawSharedSd>,
    operator_stiffness: Option<RawSharedSd>,
}

/// Parses and validates `experiment.toml` alone.
pub(super) fn parse(name: &str, toml: &str) -> Result<ExperimentFile, FileError> {
    let raw: ExperimentKeys = parse_toml(name, toml)?;
    let fail = |message: String| FileError::whole(name, message);
    let bevameter = raw.plates.is_some() || raw.shear.is_some();
    if raw.wheel.is_empty() && (raw.runs.is_some() || !bevameter) {
        return Err(fail("no wheel: add a table [wheel.NAME]".into()));
    }
    if raw.runs.is_none() && !bevameter {
        return Err(fail(
            "the experiment names no test runs: add runs = \"runs.csv\"".into(),
        ));
    }
    if raw.soil.is_empty() {
        return Err(fail("no soil: add a table [soil.NAME]".into()));
    }
    let (mut wheels, mut meshes) = (BTreeMap::new(), BTreeMap::new());
    for (wheel_name, raw_wheel) in raw.wheel {
        let (wheel, mesh) = raw_wheel
            .check()
            .map_err(|e| fail(format!("[wheel.{wheel_name}] {e}")))?;
        meshes.extend(mesh.map(|file| (wheel_name.clone(), file)));
        wheels.insert(wheel_name, wheel);
    }
    check_numbers(name, &raw.rig, &raw.soil, &raw.protocol)?;
    let noise = noise(raw.noise).map_err(|e| fail(format!("[noise] {e}")))?;
    let campaign = raw.campaign.map(Campaign::checked).transpose();
    let campaign = campaign.map_err(|e| fail(format!("[campaign] {e}")))?;
    Ok(ExperimentFile {
        campaign,
        runs: raw.runs,
        plates: raw.plates,
        shear: raw.shear,
        wheel: wheels,
        meshes,
        soil: raw.soil,
        rig: raw.rig,
        noise,
        protocol: raw.protocol,
    })
}

/// Wheels beside those of an experiment: a file with tables `[wheel.NAME]` alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WheelKeys {
    #[serde(default)]
    wheel: BTreeMap<String, RawWheel>,
}

/// Parses and validates a file with tables `[wheel.NAME]` alone. A surface mesh is refused, because it needs a file of its own.
///
/// # Errors
/// [`FileError`] names the wheel, the value, the unit and the bound.
/// Checked by `tests::wheels_stand_in_a_file_of_their_own`.
pub fn read_wheels(name: &str, toml: &str) -> Result<BTreeMap<String, WheelGeometry>, FileError> {
    let raw: WheelKeys = parse_toml(name, toml)?;
    let checked = raw.wheel.into_iter().map(|(wheel_name, raw)| {
        let fail = |message: String| FileError::whole(name, format!("[wheel.{wheel_name}] {message}"));
        match raw.check().map_err(|e| fail(e.to_string()))? {
            (_, Some(mesh)) => Err(fail(format!(
                "mesh = \"{mesh}\" has no place here: state it in the experiment"
            ))),
            (wheel, None) => Ok((wheel_name.clone(), wheel)),
        }
    });
    checked.collect()
}

/// Rejects numbers of rig, soils and protocol that are not finite or have the wrong sign; messages name the table.
fn check_numbers(
    file: &str,
    rig: &Rig,
    soils: &BTreeMap<String, SoilProperties>,
    protocol: &AveragingProtocol,
) -> Result<(), FileError> {
    let within = |table: &str, e: ValueError| FileError::whole(file, format!("[{table}] {e}"));
    let in_rig = |e| within("rig", e);
    positive("gravity_m_s2", rig.gravity_m_s2, "m/s^2").map_err(in_rig)?;
    if let Some(length) = rig.bin_length_m {
        positive("bin_length_m", length, "m").map_err(in_rig)?;
    }
    for (key, range, unit, lowest) in [
        ("slip_range", rig.slip_range, "1", -1.0),
        ("wheel_load_range_n", rig.wheel_load_range_n, "N", 0.0),
        ("sled_speed_range_m_s", rig.sled_speed_range_m_s, "m/s", 0.0),
    ] {
        let Some([least, greatest]) = range else { continue };
        let bound = format!("in [{lowest}, the greatest]");
        let is_least = least.is_finite() && least >= lowest && least <= greatest;
        require(is_least, &format!("least of {key}"), least, unit, &bound).map_err(in_rig)?;
        let (is_greatest, bound) = match key {
            "slip_range" => (greatest < 1.0, "< 1"),
            _ => (greatest.is_finite() && greatest > 0.0, "finite and > 0"),
        };
        require(is_greatest, &format!("greatest of {key}"), greatest, unit, bound).map_err(in_rig)?;
    }
    for (name, soil) in soils {
        let in_soil = |e| within(&format!("soil.{name}"), e);
        for (key, value, unit) in [
            ("density_kg_m3", soil.density_kg_m3, "kg/m^3"),
            ("repose_angle_deg", soil.repose_angle_deg, "deg"),
        ] {
            if let Some(value) = value {
                positive(key, value, unit).map_err(in_soil)?;
            }
        }
        if let Some(angle) = soil.repose_angle_deg {
            require(angle < 90.0, "repose_angle_deg", angle, "deg", "< 90").map_err(in_soil)?;
        }
    }
    let (force, sinkage) = (
        protocol.simulated_transient_force_s,
        protocol.simulated_transient_sinkage_s,
    );
    for (key, value, unit) in [
        ("measured_transient_s", protocol.measured_transient_s, "s"),
        ("simulated_transient_force_s", force, "s"),
        ("simulated_transient_sinkage_s", sinkage, "s"),
        ("lowpass_hz", protocol.lowpass_hz, "Hz"),
        ("slip_begins_m", protocol.slip_begins_m.unwrap_or(0.0), "m"),
    ] {
        not_negative(key, value, unit).map_err(|e| within("protocol", e))?;
    }
    Ok(())
}

fn noise(raw: RawNoise) -> Result<Noise, ValueError> {
    let relative = [
        raw.run_scatter,
        raw.preparation_scatter,
        raw.preparation_strength_scatter,
        raw.plate_scatter,
        raw.plate_noise,
        raw.ring_scatter,
        raw.ring_noise,
    ];
    let mut scatter = Noise::default().scatter;
    for (kind, entry) in Scatter::ALL.into_iter().zip(relative) {
        scatter[kind.index()] = kind.read(entry)?;
    }
    let shared = [
        raw.session_drawbar_pull_n,
        raw.session_torque_n_m,
        raw.session_sinkage_m,
        raw.session_lateral_force_n,
        raw.session_stiffness,
        raw.zero_drawbar_pull_n,
        raw.zero_torque_n_m,
        raw.zero_lateral_force_n,
        raw.operator_sinkage_m,
        raw.operator_stiffness,
    ];
    let mut rig = Noise::default().rig;
    for ((error, entry), sd) in RigError::ALL.into_iter().zip(shared).zip(&mut rig) {
        *sd = error.read(entry)?;
    }
    let entries = [
        raw.drawbar_pull_n,
        raw.torque_n_m,
        raw.sinkage_m,
        raw.lateral_force_n,
    ];
    let mut sd = [None; 4];
    for (channel, entry) in Channel::ALL.into_iter().zip(entries) {
        sd[channel.index()] = match entry {
            None => None,
            Some(RawSd::Number(x)) => {
                positive(channel.column(), x, channel.unit())?;
                Some(NoiseSd::Known(x))
            }
            Some(RawSd::Word(word)) => match word.as_str() {
                "replicates" => Some(NoiseSd::Replicates),
                "unknown" => Some(NoiseSd::Unknown),
                _ => {
                    let column = channel.column();
                    return Err(ValueError::Rule(format!(
                        "{column} = \"{word}\" must be a number, \"replicates\" or \"unknown\""
                    )));
                }
            },
        };
    }
    Ok(Noise { sd, scatter, rig })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheels_stand_in_a_file_of_their_own() {
        let text = "[wheel.wide]\nradius_m = 0.1\nwidth_m = 0.2\n";
        let wheels = read_wheels("wheels.toml", text).unwrap();
        assert!((wheels["wide"].rig_radius_m - 0.1).abs() < 1e-15);
        let refused = |text: &str| read_wheels("wheels.toml", text).unwrap_err().to_string();
        assert_eq!(
            refused(&text.replace("0.2", "-0.2")),
            "wheels.toml: [wheel.wide] width_m -0.2 m must be > 0 m"
        );
        assert!(refused(&format!("{text}mesh = \"a.stl\"\n")).contains("has no place here"));
        assert!(refused("[rig]\ngravity_m_s2 = 1.62\n").contains("rig"));
    }

    #[test]
    fn a_rig_sets_some_load_and_some_speed() {
        let check = |rig: Rig| {
            let protocol = AveragingProtocol::default();
            check_numbers("e.toml", &rig, &BTreeMap::new(), &protocol).map_err(|e| e.to_string())
        };
        let rig = |load: [f64; 2], speed: [f64; 2]| Rig {
            wheel_load_range_n: Some(load),
            sled_speed_range_m_s: Some(speed),
            ..Rig::default()
        };
        assert_eq!(check(rig([0.0, 90.0], [0.0, 0.02])), Ok(()));
        assert_eq!(
            check(rig([0.0, 0.0], [0.0, 0.02])).unwrap_err(),
            "e.toml: [rig] greatest of wheel_load_range_n 0 N must be finite and > 0 N"
        );
        assert_eq!(
            check(rig([90.0, 90.0], [0.0, 0.0])).unwrap_err(),
            "e.toml: [rig] greatest of sled_speed_range_m_s 0 m/s must be finite and > 0 m/s"
        );
    }
}
