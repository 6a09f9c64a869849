//! The names, units and physical bounds of the parameters.
//!
//! A parameter of one wheel of several carries the wheel's name behind a dot (`wheel_radius_m.smooth`);
//! a noise standard deviation that is inferred is `noise.` and the channel's column
//! (`noise.drawbar_pull_n`). An effect's parameter is `EFFECT.PARAMETER`, or `EFFECT.PARAMETER.WHEEL`: what is known of
//! it stands in the effect's file ([`EffectSet`]).

use std::collections::BTreeSet;

use crate::channel::Channel;
use crate::experiment::Scatter;
use crate::file::unknown_word;
use crate::model::{EffectSet, ModelKind};

/// What is known of a base parameter of the wheel-soil models.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseParameter {
    /// Name at every boundary, with its unit where it has one.
    pub name: &'static str,
    /// Unit for tables and axes.
    pub unit: &'static str,
    /// Least admissible value.
    pub lower: f64,
    /// Largest admissible value.
    pub upper: f64,
    /// Value where a job says nothing; `None` = the job must say.
    pub default: Option<f64>,
}

const fn base(
    name: &'static str,
    unit: &'static str,
    lower: f64,
    upper: f64,
    default: Option<f64>,
) -> BaseParameter {
    BaseParameter {
        name,
        unit,
        lower,
        upper,
        default,
    }
}

/// Every base parameter. `wheel_radius_m` defaults to the experiment's radius of each wheel.
pub const BASE: [BaseParameter; 10] = [
    base("k_c", "N/m^(n+1)", f64::NEG_INFINITY, f64::INFINITY, None),
    base("k_phi", "N/m^(n+2)", 0.0, f64::INFINITY, None),
    base("log10_p_ref", "log10 Pa", -3.0, 12.0, None),
    base("kappa", "1", -0.999, f64::INFINITY, None),
    base("n", "1", 0.01, 10.0, None),
    base("friction_angle_deg", "deg", 0.0, 89.0, None),
    base("wheel_radius_m", "m", 1e-4, 100.0, None),
    base("cohesion_pa", "Pa", 0.0, f64::INFINITY, Some(0.0)),
    base("shear_velocity_m_s", "m/s", 0.0, f64::INFINITY, Some(0.001)),
    base("gamma_exponent", "1", 0.0, 100.0, Some(0.5)),
];

/// Parameters of the soil's deformation, which the three-dimensional model alone has.
pub const SPATIAL: [BaseParameter; 3] = [
    base("elastic_stiffness_pa_m", "Pa/m", 1e6, 1e13, Some(1e9)),
    base("flow_fraction", "1", 0.0, 1.0, Some(0.25)),
    base("bearing_credit", "1", 0.0, 1.0, Some(0.3)),
];

/// Every base parameter that a model of some kind has.
pub fn of_kind(kind: ModelKind) -> impl Iterator<Item = &'static BaseParameter> {
    let spatial: &[BaseParameter] = match kind {
        ModelKind::QuasiStatic => &[],
        ModelKind::Scm => &SPATIAL,
    };
    BASE.iter().chain(spatial)
}

/// Unit and physical bounds of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Unit for tables and axes.
    pub unit: String,
    /// Least admissible value.
    pub lower: f64,
    /// Largest admissible value.
    pub upper: f64,
}

impl From<&BaseParameter> for Quantity {
    fn from(base: &BaseParameter) -> Self {
        Quantity {
            unit: base.unit.to_owned(),
            lower: base.lower,
            upper: base.upper,
        }
    }
}

/// Whether a name means something in jobs already, so that no effect may have it.
pub(crate) fn is_taken(name: &str) -> bool {
    // "none" is the absence of effects in results
    ["none", "noise", "bevameter"].contains(&name) || BASE.iter().chain(&SPATIAL).any(|p| p.name == name)
}

/// Natural logarithm of the ratio of tan(phi) under a ring to tan(phi) under the wheel, which share all else; a
/// parameter of a calibration with readings of a ring.
pub const RING_TRANSFER: &str = "bevameter.ln_transfer";

/// Radius of the plate at which `p_ref` and `kappa` are defined `[m]`.
pub const B_REF_M: f64 = 0.03;
/// Sinkage at which `p_ref` is defined `[m]`.
pub const Z_REF_M: f64 = 0.01;

/// Bekker's moduli `k_c` `[N/m^(n+1)]` and `k_phi` `[N/m^(n+2)]` in the place of `log10_p_ref`, `kappa` and n.
///
/// `p_ref = (k_c / b_ref + k_phi) z_ref^n`, `kappa = k_c / (k_phi b_ref)`, hence `k_phi = p_ref / (z_ref^n (1 + kappa))` and
/// `k_c = kappa k_phi b_ref`. Infinite at `kappa = -1`. The models' own conversion gives the same bits: checked by
/// `worker::model::parameters::tests::moduli_are_converted_alike_everywhere`.
pub fn bekker_moduli(log10_p_ref: f64, kappa: f64, n: f64) -> (f64, f64) {
    let k_phi = libm::exp10(log10_p_ref) / libm::pow(Z_REF_M, n) / (1.0 + kappa);
    (kappa * k_phi * B_REF_M, k_phi)
}

/// Prefix of the inferred noise standard deviations.
pub const NOISE_PREFIX: &str = "noise.";

/// The parameter that a noise sd of a channel is inferred as: `noise.drawbar_pull_n`.
pub fn noise_parameter(channel: Channel) -> String {
    format!("{NOISE_PREFIX}{}", channel.column())
}

/// The parameter that a relative scatter is inferred as: `noise.run_scatter`.
pub fn scatter_parameter(scatter: Scatter) -> String {
    format!("{NOISE_PREFIX}{}", scatter.key())
}

/// What is known of the parameter behind a name: of the model, of one of its wheels, of an effect.
///
/// # Errors
/// A sentence that names the unknown name and the nearest known one.
pub fn lookup(name: &str, wheels: &BTreeSet<&str>, effects: &EffectSet) -> Result<Quantity, String> {
    if name == RING_TRANSFER {
        return Ok(Quantity {
            unit: "1".to_owned(),
            lower: -2.0,
            upper: 2.0,
        });
    }
    let (stem, wheel) = name
        .split_once('.')
        .map_or((name, None), |(stem, wheel)| (stem, Some(wheel)));
    let found = BASE.iter().chain(&SPATIAL).find(|p| p.name == stem);
    match (found, wheel) {
        (Some(p), None) => Ok(p.into()),
        (Some(p), Some(w)) if p.name == "wheel_radius_m" => {
            if wheels.contains(w) {
                Ok(p.into())
            } else {
                Err(unknown_word("wheel", w, wheels.iter().copied()))
            }
        }
        (Some(p), Some(_)) => Err(format!(
            "parameter {} belongs to the soil, not to one wheel: \"{name}\"",
            p.name
        )),
        (None, _) => effects.lookup(name, wheels).unwrap_or_else(|| {
            let known = BASE.iter().chain(&SPATIAL).map(|p| p.name);
            Err(unknown_word("parameter", name, known))
        }),
    }
}

/// A unit behind a number in a sentence: ` m`, and nothing for a number without unit.
pub fn behind(unit: &str) -> String {
    if unit == "1" {
        String::new()
    } else {
        format!(" {unit}")
    }
}

/// Checks one value against the physical bounds of its parameter.
///
/// # Errors
/// A sentence with the name, the value, the unit and the bound.
pub fn check_value(quantity: &Quantity, name: &str, value: f64) -> Result<(), String> {
    let Quantity { unit, lower, upper } = quantity;
    if !value.is_finite() {
        return Err(format!("{name} = {value} is not a finite number"));
    }
    if value < *lower || value > *upper {
        let unit = behind(unit);
        return Err(format!(
            "{name} = {value}{unit} lies outside [{lower}, {upper}]{unit}"
        ));
    }
    Ok(())
}

/// Checks that a set of names determines a model: one way to state the stiffness, `n` and the friction
/// angle present, everything said of every effect, nothing given both for one wheel and for all.
///
/// # Errors
/// A sentence that names what is missing or said twice.
pub fn check_complete(
    names: &BTreeSet<&str>,
    wheels: &BTreeSet<&str>,
    effects: &EffectSet,
) -> Result<(), String> {
    for name in names {
        lookup(name, wheels, effects)?;
    }
    let has = |name| names.contains(name);
    match (has("k_c") && has("k_phi"), has("log10_p_ref") && has("kappa")) {
        (true, false) if has("log10_p_ref") || has("kappa") => return Err(BOTH_STIFFNESSES.into()),
        (false, true) if has("k_c") || has("k_phi") => return Err(BOTH_STIFFNESSES.into()),
        (true, true) => return Err(BOTH_STIFFNESSES.into()),
        (false, false) => return Err("the stiffness needs k_c and k_phi, or log10_p_ref and kappa".into()),
        _ => {}
    }
    for name in ["n", "friction_angle_deg"] {
        if !has(name) {
            return Err(format!("parameter {name} has neither a prior nor a fixed value"));
        }
    }
    let per_wheel = names.iter().any(|n| n.starts_with("wheel_radius_m."));
    if has("wheel_radius_m") && per_wheel {
        return Err("wheel_radius_m is given both for all wheels and for one wheel".into());
    }
    effects.check_complete(names, wheels)
}

const BOTH_STIFFNESSES: &str = "the stiffness is given twice: k_c and k_phi exclude log10_p_ref and kappa";

#[cfg(test)]
mod tests {
    use super::*;

    fn check(names: &[&str]) -> Result<(), String> {
        let (wheels, none) = (BTreeSet::from(["smooth"]), EffectSet::default());
        check_complete(&names.iter().copied().collect(), &wheels, &none)
    }

    #[test]
    fn either_stiffness_is_complete_and_both_are_refused() {
        assert_eq!(check(&["k_c", "k_phi", "n", "friction_angle_deg"]), Ok(()));
        assert_eq!(
            check(&["log10_p_ref", "kappa", "n", "friction_angle_deg"]),
            Ok(())
        );
        assert!(
            check(&["k_c", "k_phi", "kappa", "n", "friction_angle_deg"])
                .unwrap_err()
                .contains("twice")
        );
        assert!(
            check(&["k_c", "n", "friction_angle_deg"])
                .unwrap_err()
                .contains("needs")
        );
    }

    #[test]
    fn a_radius_of_an_unknown_wheel_names_the_nearest() {
        let error = lookup(
            "wheel_radius_m.smoth",
            &BTreeSet::from(["smooth"]),
            &EffectSet::default(),
        )
        .unwrap_err();
        assert_eq!(error, "unknown wheel \"smoth\"; the nearest known is \"smooth\"");
    }

    #[test]
    fn a_parameter_of_an_effect_has_a_unit_and_a_bound() {
        let name = "janosi_hanamoto.shear_modulus_m";
        let settings = toml::from_str("kind = \"scm\"").unwrap();
        let settings = crate::model::ModelSettings::from_table(&settings).unwrap();
        let effects = EffectSet::choose("job.toml", &settings, [name], &Default::default()).unwrap();
        let lookup = |name: &str| lookup(name, &BTreeSet::from(["w"]), &effects);
        assert_eq!(
            check_value(&lookup(name).unwrap(), name, -0.01).unwrap_err(),
            "janosi_hanamoto.shear_modulus_m = -0.01 m lies outside [0, inf] m"
        );
        assert_eq!(lookup("janosi_hanamoto.shear_modulus_m.w").unwrap().unit, "m");
        assert_eq!(
            lookup("janosi_hanamoto.shear_modulus").unwrap_err(),
            "unknown parameter of effect janosi_hanamoto \"shear_modulus\"; the nearest known is \"shear_modulus_m\""
        );
        assert_eq!(
            lookup("buldozing.scale").unwrap_err(),
            "unknown effect \"buldozing\"; the nearest known is \"bulldozing\""
        );
    }

    #[test]
    fn a_value_outside_its_bounds_names_value_unit_and_bound() {
        let phi = lookup("friction_angle_deg", &BTreeSet::new(), &EffectSet::default()).unwrap();
        let error = check_value(&phi, "friction_angle_deg", 95.0).unwrap_err();
        assert_eq!(error, "friction_angle_deg = 95 deg lies outside [0, 89] deg");
        let n = lookup("n", &BTreeSet::new(), &EffectSet::default()).unwrap();
        let error = check_value(&n, "n", -1.0).unwrap_err();
        assert_eq!(error, "n = -1 lies outside [0.01, 10]");
    }
}
