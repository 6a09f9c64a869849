//! The inputs and outputs of a served model.

use std::collections::BTreeMap;
use std::sync::Arc;

use shared::channel::Channel;
use shared::experiment::{
    AveragingProtocol, Experiment, Noise, Rig, RunUse, SoilProperties, TestRun, WheelGeometry,
};
use shared::model::{EffectSet, ModelKind, ModelSettings, ModelVariant, RunInput};
use shared::outcome::Outcome;

use crate::external::allowed::AllowedModels;
use crate::model::CompiledVariant;

/// The first input vector: the properties of a run.
pub const INPUTS: [RunInput; 6] = [
    RunInput::Slip,
    RunInput::WheelLoadN,
    RunInput::SledSpeedMS,
    RunInput::SlipAngleDeg,
    RunInput::RadiusM,
    RunInput::WidthM,
];

/// The second input vector: the parameters of the soil.
pub const PARAMETERS: [&str; 7] = [
    "log10_p_ref",
    "kappa",
    "n",
    "friction_angle_deg",
    "cohesion_pa",
    "shear_velocity_m_s",
    "gamma_exponent",
];

/// The output vector.
pub const OUTPUTS: [Channel; 4] = Channel::ALL;

/// The keys of `config` that describe the wheel.
const WHEEL_KEYS: [&str; 4] = [
    "grouser_count",
    "grouser_height_m",
    "grouser_thickness_m",
    "rig_radius_m",
];

/// Why a question has no answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ServedError {
    /// The input does not fit the model.
    Input(String),
    /// The model rejects the parameters.
    Rejected(String),
}

/// Evaluates a model at one run.
///
/// # Arguments
/// - `input`: values of [`INPUTS`] and of [`PARAMETERS`].
/// - `config`: for the wheel `grouser_count`, `grouser_height_m`, `grouser_thickness_m` and `rig_radius_m`; for the model
///   the keys of a job's `[model]` that only its kind has.
pub fn evaluate(kind: ModelKind, input: &[Vec<f64>], config: &toml::Table) -> Result<Vec<f64>, ServedError> {
    let sizes: Vec<usize> = input.iter().map(Vec::len).collect();
    let [run, parameters] = input else {
        return Err(wrong_sizes(&sizes));
    };
    let &[
        slip,
        wheel_load_n,
        sled_speed_m_s,
        slip_angle_deg,
        radius_m,
        width_m,
    ] = run.as_slice()
    else {
        return Err(wrong_sizes(&sizes));
    };
    if parameters.len() != PARAMETERS.len() {
        return Err(wrong_sizes(&sizes));
    }
    let number = |key: &str, default: f64| match config.get(key) {
        None => Ok(default),
        Some(value) => shared::file::number(value)
            .filter(|x| x.is_finite() && *x >= 0.0)
            .ok_or_else(|| ServedError::Input(format!("config {key} = {value} must be a number >= 0"))),
    };
    let wheel = WheelGeometry {
        radius_m,
        width_m,
        grouser_count: number("grouser_count", 0.0)? as u32,
        grouser_height_m: number("grouser_height_m", 0.0)?,
        grouser_thickness_m: number("grouser_thickness_m", 0.0)?,
        rig_radius_m: number("rig_radius_m", radius_m)?,
        mesh: None,
        tread: None,
    };
    let run = TestRun {
        name: "run".to_owned(),
        wheel: "w".to_owned(),
        soil: "s".to_owned(),
        slip,
        wheel_load_n,
        sled_speed_m_s,
        slip_angle_deg,
        pass: 1,
        order: None,
        prepared: None,
        session: None,
        zero: None,
        operator: None,
        measured: [None; 4],
        history: None,
        sd: [None; 4],
        usage: RunUse::Fit,
    };
    let variant = variant(kind, wheel, run, config)?;
    let model = CompiledVariant::new(&variant, &Arc::new(AllowedModels::default()))
        .map_err(|e| ServedError::Input(e.to_string()))?;
    for (name, &value) in PARAMETERS.iter().zip(parameters) {
        let bounds = ModelKind::QuasiStatic.parameters().find(|p| p.name == *name);
        let checked = bounds.map(|b| shared::parameters::check_value(&b.into(), name, value));
        checked
            .transpose()
            .map_err(|e| ServedError::Input(e.to_string()))?;
    }
    match model.evaluate(parameters) {
        Outcome::Evaluated(observables) => {
            let values = OUTPUTS.iter().flat_map(|channel| observables.channel(*channel));
            Ok(values.copied().collect())
        }
        Outcome::Rejected(rejection) => Err(ServedError::Rejected(rejection.message)),
        Outcome::Fault(fault) => Err(ServedError::Rejected(fault.message)),
    }
}

fn variant(
    kind: ModelKind,
    wheel: WheelGeometry,
    run: TestRun,
    config: &toml::Table,
) -> Result<ModelVariant, ServedError> {
    let mut table = toml::Table::new();
    table.insert("kind".to_owned(), kind.name().into());
    for (key, value) in config
        .iter()
        .filter(|(key, _)| !WHEEL_KEYS.contains(&key.as_str()))
    {
        let model_keys = ModelSettings::keys_of(kind);
        if !model_keys.contains(&key.as_str()) {
            let keys = [WHEEL_KEYS.as_slice(), model_keys].concat();
            let message = shared::file::unknown_word("key of config", key, keys);
            return Err(ServedError::Input(message));
        }
        table.insert(key.clone(), value.clone());
    }
    let input = |e: shared::model::ModelError| ServedError::Input(e.to_string());
    let settings = ModelSettings::from_table(&table).map_err(input)?;
    let experiment = Experiment {
        campaign: None,
        wheels: BTreeMap::from([(run.wheel.clone(), wheel)]),
        soils: BTreeMap::from([(run.soil.clone(), SoilProperties::default())]),
        rig: Rig::default(),
        noise: Noise::default(),
        protocol: AveragingProtocol::default(),
        runs: Vec::new(),
        plates: Vec::new(),
        shear: Vec::new(),
    };
    let parameters = PARAMETERS.map(String::from).to_vec();
    ModelVariant::new(&experiment, &settings, &EffectSet::default(), parameters, [&run]).map_err(input)
}

fn wrong_sizes(sizes: &[usize]) -> ServedError {
    let (inputs, parameters) = (INPUTS.len(), PARAMETERS.len());
    ServedError::Input(format!(
        "inputs of the sizes {sizes:?} must be of the sizes [{inputs}, {parameters}]"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUN: [f64; 6] = [0.2, 100.0, 0.01, 0.0, 0.125, 0.112];
    const SOIL: [f64; 7] = [4.56, 0.0, 1.1, 30.0, 0.0, 0.001, 0.5];

    fn quasi_static(run: [f64; 6], soil: [f64; 7], config: &str) -> Result<Vec<f64>, ServedError> {
        let input = [run.to_vec(), soil.to_vec()];
        evaluate(ModelKind::QuasiStatic, &input, &config.parse().unwrap())
    }

    #[test]
    fn a_run_has_its_channels() {
        let channels = quasi_static(RUN, SOIL, "").unwrap();
        assert_eq!(channels.len(), OUTPUTS.len());
        assert!(channels[0] > 0.0 && channels[2] > 0.0, "{channels:?}");
        let wheel = "grouser_count = 12\ngrouser_height_m = 0.009\ngrouser_thickness_m = 0.002\n";
        let mut slips = RUN;
        slips[0] = 0.6;
        let smooth = quasi_static(slips, SOIL, wheel).unwrap();
        let rolled = quasi_static(slips, SOIL, &format!("{wheel}grousers = \"rolled\"")).unwrap();
        assert!(rolled[2] > 1.5 * smooth[2], "{rolled:?} {smooth:?}");
        let wider = quasi_static(RUN, SOIL, "rig_radius_m = 0.14").unwrap();
        assert!(wider[1].to_bits() != channels[1].to_bits());
    }

    #[test]
    fn invalid_input_differs_from_a_rejection() {
        let mut soft = SOIL;
        soft[0] = 0.0;
        assert!(matches!(
            quasi_static(RUN, soft, ""),
            Err(ServedError::Rejected(_))
        ));
        let mut steep = SOIL;
        steep[3] = 95.0;
        let message = format!("{:?}", quasi_static(RUN, steep, "").unwrap_err());
        assert!(message.contains("friction_angle_deg = 95 deg"), "{message}");
        for config in ["dem_spacing_m = 0.004", "grouser_count = -1"] {
            assert!(matches!(
                quasi_static(RUN, SOIL, config),
                Err(ServedError::Input(_))
            ));
        }
        let sizes = evaluate(ModelKind::Scm, &[vec![0.5; 7], vec![0.5; 8]], &toml::Table::new());
        assert!(matches!(sizes, Err(ServedError::Input(_))));
    }
}
