//! The changes by effects: figures of another implementation, and equivalent changes of the base.
//!
//! The rows are quasi-static; the three-dimensional model has separate ones.

use formula::Effect;
use formula::catalogue::find;
use scm::Averages;
use scm::effects::Site;

use super::Rows;
use crate::support::{Case, base, compiled};

const SIGNATURES: &str = include_str!("../reference/signatures.csv");

/// Half of the last printed digit, in N, N m and mm; and the error of the other implementation's coarse strips.
const ROUNDING: [f64; 3] = [0.05, 0.005, 0.05];
const RELATIVE: f64 = 0.02;

/// Slip, load and rim speed of each column of the table.
const COLUMNS: [(&str, f64, f64, f64); 6] = [
    ("s .05", 0.05, 100.0, 0.01),
    ("s .2", 0.2, 100.0, 0.01),
    ("s .6", 0.6, 100.0, 0.01),
    ("60 N", 0.2, 60.0, 0.01),
    ("150 N", 0.2, 150.0, 0.01),
    ("50 mm/s", 0.2, 100.0, 0.05),
];

/// The site of the table; only lug thrust uses the grousers.
pub(crate) const SITE: Site = Site {
    density_kg_m3: Some(1400.0),
    gravity_m_s2: 9.81,
    grouser_count: 12,
    grouser_height_m: 0.009,
    bin_length_m: Some(1.5),
    order: Some(0.5),
};

/// The wheel of the table is larger than the rig assumes.
pub(crate) fn reference(slip: f64, load: f64, rim_speed: f64) -> Case {
    let mut case = base(slip, load, 30.0);
    case.wheel.radius_m = 0.13;
    case.condition.sled_speed_m_s = rim_speed * (1.0 - slip);
    case
}

/// Values of an effect's parameters: one strength as given, the other strengths neutral, shapes as fixed in the file.
pub(crate) fn values(effect: &Effect, strength: &str, value: f64) -> Vec<f64> {
    let value = |p: &formula::Parameter| match p.neutral {
        _ if p.name == strength => value,
        Some(neutral) => neutral,
        None => p.prior.as_float().expect("a shape parameter is a number"),
    };
    effect.parameters.iter().map(value).collect()
}

/// Returns a run with one effect of the catalogue.
pub(crate) fn with_effect(case: &Case, name: &str, strength: &str, value: f64, site: &Site) -> Averages {
    let effect = find(name).expect("an effect of the catalogue");
    assert!(effect.parameter(strength).is_some(), "{name} has no {strength}");
    let effects = compiled([effect]);
    case.simulate_with(&mut effects.activate([values(effect, strength, value)]), site)
        .unwrap_or_else(|rejection| panic!("{name}: {rejection}"))
}

fn channels(averages: &Averages) -> [f64; 3] {
    [
        averages.drawbar_pull_n,
        averages.torque_n_m,
        1e3 * averages.sinkage_m,
    ]
}

pub(crate) fn add(rows: &mut Rows) {
    for line in SIGNATURES.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |field: &str| -> f64 { field.parse().expect("a number") };
        let (name, strength, value) = (fields[0], fields[1], number(fields[2]));
        for (column, expected) in COLUMNS.iter().zip(fields[3..].chunks_exact(3)) {
            let (column, slip, load, rim_speed) = *column;
            let case = reference(slip, load, rim_speed);
            let before = channels(&case.simulate());
            let after = channels(&with_effect(&case, name, strength, value, &SITE));
            for (i, quantity) in ["dF [N]", "dT [N m]", "dz [mm]"].into_iter().enumerate() {
                let expected = number(expected[i]);
                let exception = EXCEPTIONS.iter().find(|e| (e.0, e.1, e.2) == (name, column, i));
                let slack = exception.map_or(0.0, |e| e.3);
                let tolerance = 1.02 * ROUNDING[i] + RELATIVE * expected.abs() + slack;
                let case = format!("{name}, {column}");
                rows.add(&case, quantity, expected, after[i] - before[i], tolerance);
            }
        }
    }
    add_equivalents(rows);
}

/// Tolerated errors of the table's figures beyond rounding [N]. Side wall: there its shear stress carries no load. Flexible
/// wheel: the ends of the flat lie within strips there.
const EXCEPTIONS: [(&str, &str, usize, f64); 2] = [
    ("side_wall_friction", "150 N", 0, 0.02),
    ("wheel_flexibility", "s .05", 0, 0.005),
];

/// Adds effects without published figures that the base can imitate with another soil.
fn add_equivalents(rows: &mut Rows) {
    let moon = Site {
        gravity_m_s2: 1.62,
        ..SITE
    };
    let mean = |stiffening: f64| 1.0 + 2.0 * stiffening * 0.1 / 1.5 * (1.0 - libm::exp(-15.0));
    let (weaker, softer) = ((1.62_f64 / 9.81).powf(0.7), libm::exp(-0.1));
    for (name, strength, value, site, factor) in [
        ("gravity_scaling", "gravity_exponent", 0.7, moon, weaker),
        ("end_wall", "wall_stiffening", 0.3, SITE, mean(0.3)),
        ("slip_softened_pressure", "softening_per_slip", 0.5, SITE, softer),
    ] {
        let case = reference(0.2, 100.0, 0.01);
        let mut equivalent = case;
        equivalent.soil.k_phi *= factor;
        let expected = channels(&equivalent.simulate());
        let got = channels(&with_effect(&case, name, strength, value, &site));
        for (i, quantity) in ["F [N]", "T [N m]", "z [mm]"].into_iter().enumerate() {
            let (case, tolerance) = (format!("{name}, other soil"), 1e-6 * expected[i].abs());
            rows.add(&case, quantity, expected[i], got[i], tolerance);
        }
    }
}
