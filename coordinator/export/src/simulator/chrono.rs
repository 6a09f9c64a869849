//! A calibrated model as Project Chrono reads it: soil, terrain, draws, and a single-wheel rig.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use shared::experiment::rim_speed_m_s;
use shared::model::{DrawnModel, ModelKind};
use shared::parameters::{B_REF_M, WHEEL_RADIUS, Z_REF_M, bekker_moduli};

use crate::error::ExportError;

/// The effect that Chrono's SCM has, too: shear that builds up with displacement.
const SHEAR: &str = "janosi_hanamoto";
/// Its displacement where the model has shear that is mobilised at once `[m]`: small against a contact, and above the 0 that Chrono
/// divides by.
const AT_ONCE_M: f64 = 1e-5;
/// Chrono's own stiffness of unloading `[Pa/m]` and damping `[Pa s/m]`, which averages of steady runs do not determine.
const ELASTIC_PA_M: f64 = 2e8;
const DAMPING_PA_S_M: f64 = 3e4;
/// Names of the calibrated soil parameters in Chrono's files.
const NAMES: [&str; 6] = [
    "Bekker Kphi",
    "Bekker Kc",
    "Bekker n",
    "Mohr Cohesion",
    "Mohr Friction",
    "Janosi Shear",
];

/// Returns the files of a folder by name.
///
/// `soil.json` has the mean soil of the draws, `terrain.json` names it, `rig.yaml` has the wheel on its carriage, `draws.csv` the
/// soil at each draw, and `README.md` says how they are used.
///
/// # Errors
/// [`ExportError::Chrono`]: the model is not a Soil Contact Model, or has no condition.
///
/// # Validity
/// Effects other than `janosi_hanamoto` are not in Chrono's Soil Contact Model; `README.md` lists those that are left out.
///
/// # Source
/// The files `data/vehicle/terrain/SCMPlane.json`, `scm_soil_parameters/` and `data/yaml/mbs/` of Project Chrono 10. Checked by
/// `tests::the_soil_has_the_units_of_chrono` and by `simulators::a_calibration_is_exported_for_simulators` of the tests of the farm.
pub fn chrono(model: &DrawnModel) -> Result<BTreeMap<String, Vec<u8>>, ExportError> {
    if !matches!(model.variant.kind, ModelKind::QuasiStatic | ModelKind::Scm) {
        let kind = model.variant.kind.name();
        let message = format!("a model of kind {kind} has no soil of Project Chrono's Soil Contact Model");
        return Err(ExportError::Chrono(message));
    }
    let draws: Vec<[f64; 6]> = (0..model.draws.len())
        .map(|draw| soil(model, draw))
        .collect::<Result<_, _>>()?;
    let mut csv = NAMES.join(",") + "\n";
    for soil in &draws {
        csv += &(soil.map(|value| value.to_string()).join(",") + "\n");
    }
    let files = [
        ("soil.json", pretty(&soil_file(&model.name, mean_soil(&draws)))),
        ("terrain.json", pretty(&terrain_file(model))),
        ("rig.yaml", rig(model)?),
        ("draws.csv", csv),
        ("README.md", read_me(model)),
    ];
    Ok(files
        .map(|(name, text)| (name.to_owned(), text.into_bytes()))
        .into())
}

/// Returns the soil at a draw, in the order and units of [`NAMES`].
fn soil(model: &DrawnModel, draw: usize) -> Result<[f64; 6], ExportError> {
    let value = |name: &str| {
        let unset = || ExportError::Chrono(format!("the model has no parameter {name}"));
        model.parameter(name, draw).ok_or_else(unset)
    };
    let n = value("n")?;
    let (k_c, k_phi) = match model.parameter("k_phi", draw) {
        Some(k_phi) => (value("k_c")?, k_phi),
        None => bekker_moduli(value("log10_p_ref")?, value("kappa")?, n),
    };
    let shear_m = model.parameter(&format!("{SHEAR}.shear_modulus_m"), draw);
    let shear_m = shear_m.unwrap_or(0.0).max(AT_ONCE_M);
    Ok([
        k_phi,
        k_c,
        n,
        value("cohesion_pa")?,
        value("friction_angle_deg")?,
        shear_m,
    ])
}

/// Returns the mean of the soils.
///
/// The unit of Bekker's moduli depends on the exponent n, so they have no mean of their own. What is averaged is n, the logarithm of the
/// pressure at the reference plate and sinkage, and the share of `k_c` in it; the moduli follow from these. Checked by
/// `tests::the_mean_soil_has_the_mean_pressure_at_the_reference`.
fn mean_soil(draws: &[[f64; 6]]) -> [f64; 6] {
    let mean = |of: &dyn Fn(&[f64; 6]) -> f64| draws.iter().map(of).sum::<f64>() / draws.len() as f64;
    let modulus = |soil: &[f64; 6]| soil[1] / B_REF_M + soil[0];
    let n = mean(&|soil| soil[2]);
    let share = mean(&|soil| soil[1] / B_REF_M / modulus(soil));
    let log_pressure = mean(&|soil| libm::log(modulus(soil)) + soil[2] * libm::log(Z_REF_M));
    let sum = libm::exp(log_pressure - n * libm::log(Z_REF_M));
    [
        (1.0 - share) * sum,
        share * sum * B_REF_M,
        n,
        mean(&|soil| soil[3]),
        mean(&|soil| soil[4]),
        mean(&|soil| soil[5]),
    ]
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}

fn soil_file(name: &str, soil: [f64; 6]) -> Value {
    let mut parameters: serde_json::Map<String, Value> = NAMES
        .iter()
        .zip(soil)
        .map(|(name, value)| ((*name).to_owned(), json!(value)))
        .collect();
    parameters.insert("Elastic K".into(), json!(ELASTIC_PA_M));
    parameters.insert("Dampening R".into(), json!(DAMPING_PA_S_M));
    json!({
        "Name": format!("calibrated: {name}"),
        "Type": "Terrain Properties",
        "Template": "SCM Soil Parameters",
        "Soil Parameters": parameters,
    })
}

fn terrain_file(model: &DrawnModel) -> Value {
    let condition = model.variant.conditions.first();
    let angle = condition.and_then(|condition| condition.repose_angle_deg);
    json!({
        "Name": "bin of a single-wheel rig",
        "Type": "Terrain",
        "Template": "SCMDeformableTerrain",
        "Bulldozing Parameters": {
            "Do Bulldozing": angle.is_some(),
            "Erosion Angle": angle.unwrap_or(35.0),
            "Flow Factor": 1,
            "Erosion Iterations": 5,
            "Erosion Propagation": 10
        },
        "Refinement Parameters": { "Do Refinement": false, "Resolution": 0.01 },
        "Soil Parameters": { "Input File": "soil.json" },
        "Geometry": { "Height": 0, "Size": [3, 1], "Divisions": [600, 200] },
        "Visualization": {
            "Color": [0.5, 0.5, 0.8],
            "Plot": { "Type": "Sinkage", "Minimum": 0, "Maximum": 0.05 }
        },
        "Offset": { "High": 0.1, "Low": 0.5 }
    })
}

/// Returns the mean of a wheel's radius over the draws, if the calibration inferred it or stated another than that of the wheel.
fn mean_radius_m(model: &DrawnModel, wheel: &str, stated_m: f64) -> f64 {
    let draws = model.draws.len();
    let at = |draw: usize| {
        let own = model.parameter(&format!("{WHEEL_RADIUS}.{wheel}"), draw);
        own.or_else(|| model.parameter(WHEEL_RADIUS, draw))
            .unwrap_or(stated_m)
    };
    (0..draws).map(at).sum::<f64>() / draws as f64
}

/// Returns the rig: a carriage at constant speed, an axle that slides up and down on it, and a wheel at constant speed of rotation. Mass
/// and inertia of axle and wheel are those of the load, because a steady run does not depend on how they share it.
fn rig(model: &DrawnModel) -> Result<String, ExportError> {
    let none = || ExportError::Chrono("the model has no condition with a wheel".into());
    let condition = model.variant.conditions.first().ok_or_else(none)?;
    let wheel = model.variant.wheels.get(&condition.wheel).ok_or_else(none)?;
    let mass = 0.5 * condition.wheel_load_n / model.variant.gravity_m_s2;
    let (radius, width) = (
        mean_radius_m(model, &condition.wheel, wheel.radius_m),
        wheel.width_m,
    );
    let moments = [
        mass * (3.0 * radius * radius + width * width) / 12.0,
        0.5 * mass * radius * radius,
        mass * (3.0 * radius * radius + width * width) / 12.0,
    ];
    let angle = condition.slip_angle_deg.to_radians();
    let axis = [libm::sin(angle), libm::cos(angle), 0.0];
    let omega = rim_speed_m_s(condition.slip, condition.sled_speed_m_s) / wheel.rig_radius_m;
    Ok(format!(
        "chrono-version: 10.0

# Load {load} N, slip {slip}, speed {speed} m/s, slip angle {slip_angle} deg. The motor of the wheel has the speed of that slip.
# The masses give this load under a gravity of {gravity} m/s^2: set the system's gravity to [0, 0, -{gravity}].
model:
  name: single_wheel_rig
  angle_degrees: true

  data_path:
    type: RELATIVE
    root: \".\"

  bodies:
    - name: ground
      location: [0, 0, 0]
      fixed: true

    - name: carriage
      location: [0, 0, {radius}]
      mass: 1.0
      inertia:
        moments: [1, 1, 1]
        products: [0, 0, 0]

    - name: axle
      location: [0, 0, {radius}]
      mass: {mass}
      inertia:
        moments: [{mx}, {my}, {mz}]
        products: [0, 0, 0]

    - name: wheel
      location: [0, 0, {radius}]
      mass: {mass}
      inertia:
        moments: [{mx}, {my}, {mz}]
        products: [0, 0, 0]
      contact:
        materials:
          - name: rim
            coefficient_of_friction: 0.8
        shapes:
          - type: CYLINDER
            material: rim
            radius: {radius}
            length: {width}
            location: [0, 0, 0]
            axis: [{ax}, {ay}, {az}]
      visualization:
        shapes:
          - type: CYLINDER
            radius: {radius}
            length: {width}
            location: [0, 0, 0]
            axis: [{ax}, {ay}, {az}]

  joints:
    - name: vertical_guide
      type: PRISMATIC
      body1: axle
      body2: carriage
      location: [0, 0, {radius}]
      axis: [0, 0, 1]

  motors:
    - name: sled
      type: LINEAR
      guide: PRISMATIC
      body1: carriage
      body2: ground
      location: [0, 0, {radius}]
      axis: [1, 0, 0]
      actuation_type: SPEED
      actuation_function:
        type: CONSTANT
        value: {speed}

    - name: wheel
      type: ROTATION
      spindle: REVOLUTE
      body1: wheel
      body2: axle
      location: [0, 0, {radius}]
      axis: [{ax}, {ay}, {az}]
      actuation_type: SPEED
      actuation_function:
        type: CONSTANT
        value: {omega}
",
        load = condition.wheel_load_n,
        gravity = model.variant.gravity_m_s2,
        slip = condition.slip,
        slip_angle = condition.slip_angle_deg,
        speed = condition.sled_speed_m_s,
        mx = moments[0],
        my = moments[1],
        mz = moments[2],
        ax = axis[0],
        ay = axis[1],
        az = axis[2],
    ))
}

/// Returns what is in the folder, and what Chrono does not have.
fn read_me(model: &DrawnModel) -> String {
    let effects = model.variant.effects.iter().map(|effect| effect.name.as_str());
    let missing: Vec<&str> = effects.filter(|name| *name != SHEAR).collect();
    let missing = match missing.is_empty() {
        true => "Chrono's Soil Contact Model has all effects of this model.".to_owned(),
        false => format!(
            "Chrono's Soil Contact Model does not have these effects of the calibrated model, and will differ from it: {}.",
            missing.join(", ")
        ),
    };
    format!(
        "# Calibration {}: {}

`soil.json` has the mean soil of {} draws of the posterior: of n, of the logarithm of the pressure at the reference plate and sinkage, and of
the other parameters, because the unit of Bekker's moduli depends on n. `draws.csv` has each draw: simulate some of them for an interval.
`terrain.json` is a terrain with this soil. `rig.yaml` is the wheel on its rig, for Chrono's reader of multi-body models; the terrain
is added in your program, with the body `wheel` as what it touches.

Units are SI, angles in degrees. Elastic K and Dampening R are Chrono's usual values: averages of steady runs do not determine them. A Janosi
Shear of {AT_ONCE_M} m stands for shear that is mobilised at once. The masses of the rig are its load over a gravity of {} m/s^2: set the
gravity of Chrono's system to this value.

{missing}
",
        model.calibration,
        model.name,
        model.draws.len(),
        model.variant.gravity_m_s2
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_soil_has_the_units_of_chrono() {
        let files = chrono(&super::super::fixture::model()).unwrap();
        let text = |name: &str| String::from_utf8(files[name].clone()).unwrap();
        let file: Value = serde_json::from_str(&text("soil.json")).unwrap();
        let soil = &file["Soil Parameters"];
        assert!((soil["Bekker Kphi"].as_f64().unwrap() - 2e6).abs() < 1e-3);
        assert!((soil["Bekker n"].as_f64().unwrap() - 1.1).abs() < 1e-12);
        assert_eq!(soil["Mohr Friction"], 30.0);
        assert_eq!(soil["Mohr Cohesion"], 100.0);
        assert_eq!(soil["Janosi Shear"], AT_ONCE_M);
        assert_eq!(soil["Dampening R"], 3e4);
        assert_eq!(
            text("draws.csv").lines().nth(2),
            Some("2000000,0,1.2,100,30,0.00001")
        );
        assert!(text("README.md").contains("has all effects"));
        let gravity = super::super::fixture::model().variant.gravity_m_s2;
        assert!(text("README.md").contains(&format!("gravity of {gravity} m/s^2")));
        assert!(text("rig.yaml").contains(&format!("gravity to [0, 0, -{gravity}]")));
    }

    #[test]
    fn the_mean_soil_has_the_mean_pressure_at_the_reference() {
        // The same pressure and ratio of moduli at two exponents: k_phi differs by a factor of 16.
        let draws = [0.8, 1.4].map(|n| {
            let (k_c, k_phi) = bekker_moduli(4.0, 0.25, n);
            [k_phi, k_c, n, 100.0, 30.0, 0.01]
        });
        let [k_phi, k_c, n, ..] = mean_soil(&draws);
        let pressure = (k_c / B_REF_M + k_phi) * libm::pow(Z_REF_M, n);
        assert!((pressure - 1e4).abs() < 1e-6, "{pressure} Pa");
        assert!((k_c / (k_phi * B_REF_M) - 0.25).abs() < 1e-12);
        assert!((n - 1.1).abs() < 1e-12);
    }
}
