//! The change of drawbar pull, torque and sinkage by an effect, for one wheel in one sand.

use formula::slip::variables;
use formula::{Effect, Variable};
use serde::{Deserialize, Serialize};
use shared::experiment::{
    AveragingProtocol, Experiment, Noise, Rig, RunUse, SoilProperties, TestRun, WheelGeometry,
};
use shared::model::effects::parameter_name;
use shared::model::{EffectSet, EffectText, ModelKind, ModelSettings, ModelVariant};
use utoipa::ToSchema;

use crate::embedded::Evaluate;

/// The shown channels with their units.
pub const CHANNELS: [(&str, &str); 3] = [("drawbar_pull", "N"), ("torque", "N m"), ("sinkage", "mm")];
/// Factors from SI units to those of [`CHANNELS`].
const FACTORS: [f64; 3] = [1.0, 1.0, 1000.0];

/// Speed of the rim by the rig's radius `[m/s]`.
const RIM_M_S: f64 = 0.01;
/// Radius with which the rig turns slip into rim speed `[m]`.
const RIG_RADIUS_M: f64 = 0.125;

/// Columns of the table: name, slip, wheel load `[N]`, speed of the rim `[m/s]`.
const COLUMNS: [(&str, f64, f64, f64); 6] = [
    ("slip 0.05", 0.05, 100.0, RIM_M_S),
    ("slip 0.2", 0.2, 100.0, RIM_M_S),
    ("slip 0.6", 0.6, 100.0, RIM_M_S),
    ("60 N", 0.2, 60.0, RIM_M_S),
    ("150 N", 0.2, 150.0, RIM_M_S),
    ("50 mm/s", 0.2, 100.0, 0.05),
];

/// Slip angle at which effects are shown that are absent straight ahead `[deg]`.
const SIDEWAYS_DEG: f64 = 30.0;
/// Numbers of the first and the last run of a series; the signature shows last runs.
const FIRST: i32 = 0;
const LAST: i32 = 1;
/// Points of the curves over slip: from −0.4 in steps of 0.05 to 0.8.
const POINTS: usize = 25;

/// The changes by each strength of an effect.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct Signature {
    /// Kind of the model that computes the signature.
    pub model_kind: String,
    /// Number of the shown pass over the track.
    pub pass: u32,
    /// Angle from the wheel's heading to the travel `[deg]`: 0 unless the effect is absent straight ahead.
    pub slip_angle_deg: f64,
    /// Names of the conditions in the tables; slip 0.2, 100 N and 10 mm/s of rim speed unless the name states others.
    pub conditions: Vec<String>,
    /// The other parameters, which only shape the effect.
    pub shapes: Vec<HeldParameter>,
    /// Slips of the curves.
    pub slips: Vec<f64>,
    /// Changes by each strength alone, at its typical value.
    pub strengths: Vec<StrengthSignature>,
}

/// A parameter that is held at a value.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct HeldParameter {
    /// Name.
    pub name: String,
    /// Value at which it is held.
    pub value: f64,
    /// Unit of the value.
    pub unit: String,
}

impl HeldParameter {
    /// Returns a parameter at the value at which it is shown; `None` if it has none.
    fn shown(parameter: &formula::Parameter) -> Option<Self> {
        Some(HeldParameter {
            name: parameter.name.clone(),
            value: parameter.shown_at()?,
            unit: parameter.unit.clone(),
        })
    }
}

/// The changes by one strength.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct StrengthSignature {
    /// The parameter; empty for an effect without parameters.
    pub parameter: String,
    /// Value; null for an effect without parameters.
    pub value: Option<f64>,
    /// Unit.
    pub unit: String,
    /// Pull \[N\], torque \[N m\] and sinkage \[mm\].
    pub channels: Vec<ChannelSignature>,
    /// Reason of the model's refusal, if it refuses.
    pub refusal: Option<String>,
}

/// The change of one channel; null where the model refuses.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct ChannelSignature {
    /// Name of the channel.
    pub channel: String,
    /// Unit of the channel.
    pub unit: String,
    /// Values without the effect, by condition.
    pub base: Vec<Option<f64>>,
    /// Differences with and without the effect, by condition.
    pub change: Vec<Option<f64>>,
    /// Differences over slip, at 100 N and 10 mm/s.
    pub curve: Vec<Option<f64>>,
}

/// Computes the signature of an effect.
///
/// # Errors
/// A sentence: the model cannot express it.
pub fn signature(effect: &Effect, kind: ModelKind) -> Result<Signature, String> {
    let pass = if effect.uses().contains(Variable::Pass) {
        2
    } else {
        1
    };
    let is_absent = |slip: f64| effect.is_absent_at(&variables(slip, 0.0));
    let slip_angle_deg = if is_absent(0.2) && is_absent(-0.2) {
        SIDEWAYS_DEG
    } else {
        0.0
    };
    let slips: Vec<f64> = (0..POINTS).map(|i| (i as f64 - 8.0) / 20.0).collect();
    let reference = Reference::new(effect, kind, runs(&slips, slip_angle_deg, pass))?;
    let base = reference.simulate(None)?;
    let mut shown: Vec<StrengthSignature> = Vec::new();
    for parameter in effect.parameters.iter().filter(|p| p.neutral.is_some()) {
        let Some(value) = parameter.shown_at() else {
            continue;
        };
        let with = reference.simulate(Some((&parameter.name, value)))?;
        shown.push(compare(
            &base,
            &with,
            &parameter.name,
            Some(value),
            &parameter.unit,
        ));
    }
    if effect.parameters.is_empty() {
        let without = Reference {
            set: EffectSet::default(),
            effect: None,
            ..reference.clone()
        };
        shown.push(compare(&without.simulate(None)?, &base, "", None, "1"));
    }
    Ok(Signature {
        model_kind: kind.name().to_owned(),
        pass,
        slip_angle_deg,
        conditions: COLUMNS.iter().map(|c| c.0.to_owned()).collect(),
        shapes: effect
            .parameters
            .iter()
            .filter(|p| p.neutral.is_none())
            .filter_map(HeldParameter::shown)
            .collect(),
        slips,
        strengths: shown,
    })
}

/// Returns the runs of the table and of the curves over slip, and the first run of the series.
fn runs(slips: &[f64], slip_angle_deg: f64, pass: u32) -> Vec<TestRun> {
    let run = |column| TestRun {
        slip_angle_deg,
        ..run(column, pass)
    };
    let curve = slips.iter().map(|&slip| ("", slip, 100.0, RIM_M_S));
    let mut runs: Vec<TestRun> = COLUMNS.into_iter().chain(curve).map(run).collect();
    runs.push(TestRun {
        order: Some(FIRST),
        ..run(COLUMNS[0])
    });
    runs
}

type Averages = Vec<Result<[f64; 3], String>>;

fn compare(
    base: &Averages,
    with: &Averages,
    name: &str,
    value: Option<f64>,
    unit: &str,
) -> StrengthSignature {
    let channel = |c: usize| {
        let value = |averages: &Result<[f64; 3], String>| averages.as_ref().ok().map(|a| a[c] * FACTORS[c]);
        let change = |i: usize| Some(value(&with[i])? - value(&base[i])?);
        ChannelSignature {
            channel: CHANNELS[c].0.to_owned(),
            unit: CHANNELS[c].1.to_owned(),
            base: base[..COLUMNS.len()].iter().map(value).collect(),
            change: (0..COLUMNS.len()).map(change).collect(),
            curve: (COLUMNS.len()..base.len()).map(change).collect(),
        }
    };
    StrengthSignature {
        parameter: name.to_owned(),
        value,
        unit: unit.to_owned(),
        channels: (0..CHANNELS.len()).map(channel).collect(),
        refusal: base.iter().chain(with).find_map(|a| a.as_ref().err().cloned()),
    }
}

/// One wheel in one sand, and an effect.
#[derive(Clone)]
struct Reference<'a> {
    experiment: Experiment,
    settings: ModelSettings,
    set: EffectSet,
    effect: Option<&'a Effect>,
}

impl<'a> Reference<'a> {
    fn new(effect: &'a Effect, kind: ModelKind, runs: Vec<TestRun>) -> Result<Self, String> {
        let wheel = WheelGeometry {
            radius_m: 0.130,
            width_m: 0.112,
            grouser_count: 12,
            grouser_height_m: 0.009,
            grouser_thickness_m: 0.002,
            rig_radius_m: RIG_RADIUS_M,
            mesh: None,
            tread: None,
        };
        let soil = SoilProperties {
            density_kg_m3: Some(1400.0),
            repose_angle_deg: None,
        };
        let experiment = Experiment {
            campaign: None,
            wheels: [("w".to_owned(), wheel)].into(),
            soils: [("s".to_owned(), soil)].into(),
            rig: Rig {
                bin_length_m: Some(1.5),
                ..Rig::default()
            },
            noise: Noise::default(),
            protocol: AveragingProtocol::default(),
            runs,
            plates: Vec::new(),
            shear: Vec::new(),
        };
        let mut settings =
            ModelSettings::from_table(&[("kind".to_owned(), kind.name().into())].into_iter().collect())?;
        for (name, value) in [
            ("k_c", 0.0),
            ("k_phi", 1e7),
            ("n", 1.1),
            ("friction_angle_deg", 30.0),
            ("shear_velocity_m_s", 0.001),
        ] {
            settings.fixed.insert(name.to_owned(), value);
        }
        let text = EffectText {
            name: effect.name.clone(),
            text: effect.text.clone(),
        };
        Ok(Reference {
            experiment,
            settings,
            set: EffectSet::read(&[text])?,
            effect: Some(effect),
        })
    }

    /// Simulates every run with at most one strength away from its neutral value.
    fn simulate(&self, strength: Option<(&str, f64)>) -> Result<Averages, String> {
        let mut settings = self.settings.clone();
        for parameter in self.effect.iter().flat_map(|e| &e.parameters) {
            let value = match (strength, parameter.neutral) {
                (Some((name, value)), Some(_)) if name == parameter.name => Some(value),
                (_, Some(neutral)) => Some(neutral),
                (_, None) => parameter.shown_at(),
            };
            let name = self.effect.map(|e| parameter_name(e, parameter, None));
            if let (Some(name), Some(value)) = (name, value) {
                settings.fixed.insert(name, value);
            }
        }
        let shown = |run: &&TestRun| run.order == Some(LAST);
        let runs = self.experiment.runs.iter().filter(shown);
        let variant = ModelVariant::new(&self.experiment, &settings, &self.set, Vec::new(), runs)?;
        Ok(Evaluate::new(&variant)?.each(&[]))
    }
}

fn run((_, slip, wheel_load_n, rim_m_s): (&str, f64, f64, f64), pass: u32) -> TestRun {
    // slip = (omega R - v) / max(omega R, v)
    let sled_speed_m_s = if slip < 0.0 {
        rim_m_s / (1.0 + slip)
    } else {
        rim_m_s * (1.0 - slip)
    };
    TestRun {
        name: String::new(),
        wheel: "w".into(),
        soil: "s".into(),
        slip,
        wheel_load_n,
        sled_speed_m_s,
        slip_angle_deg: 0.0,
        pass,
        order: Some(LAST),
        prepared: None,
        session: None,
        zero: None,
        operator: None,
        measured: [None; 4],
        history: None,
        sd: [None; 4],
        usage: RunUse::Fit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use formula::catalogue::find;

    #[test]
    fn an_effect_of_the_slip_angle_is_shown_at_one() {
        let shown = signature(find("side_drag").unwrap(), ModelKind::QuasiStatic).unwrap();
        assert!((shown.slip_angle_deg - SIDEWAYS_DEG).abs() < f64::EPSILON);
        assert!(
            shown.strengths[0].channels[0].change[0].unwrap() < -0.01,
            "{shown:?}"
        );
    }

    #[test]
    fn a_tare_takes_itself_from_the_pull_and_leaves_the_rest() {
        let shown = signature(find("sled_tare").unwrap(), ModelKind::QuasiStatic).unwrap();
        let [tare] = shown.strengths.as_slice() else {
            panic!("{shown:?}")
        };
        for (channel, expected) in tare.channels.iter().zip([-3.0, 0.0, 0.0]) {
            for change in channel.change.iter().chain(&channel.curve) {
                assert!((change.unwrap() - expected).abs() < 1e-9, "{channel:?}");
            }
        }
        assert!(shown.slip_angle_deg.abs() < f64::EPSILON);
        assert!((shown.slips[0] + 0.4).abs() < 1e-12 && (shown.slips[POINTS - 1] - 0.8).abs() < 1e-12);
    }
}
