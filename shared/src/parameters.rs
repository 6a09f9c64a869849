//! The names, units and physical bounds of the base parameters.
//!
//! A parameter of one wheel of several carries the wheel's name behind a dot (`wheel_radius_m.smooth`);
//! a noise standard deviation that is inferred is `noise.` and the channel's column
//! (`noise.drawbar_pull_n`). Of the effects' parameters (`EFFECT.PARAMETER`) this version knows those in
//! [`EFFECTS`].

use std::collections::BTreeSet;

use crate::channel::Channel;
use crate::file::unknown_word;
use crate::model::ModelKind;

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

/// Every known parameter of an effect, with the value at which the effect is absent. A variant that says
/// nothing of one does not carry it, so its hash is that of a version without the effect.
///
/// `janosi_hanamoto.shear_modulus_m`: K of `tau = tau_max (1 − exp(−j / K))`; 0: no displacement law.
pub const EFFECTS: [BaseParameter; 1] = [base(SHEAR_MODULUS, "m", 0.0, f64::INFINITY, Some(0.0))];

/// Name of the modulus of the shear-displacement law.
pub const SHEAR_MODULUS: &str = "janosi_hanamoto.shear_modulus_m";

/// Prefix of the inferred noise standard deviations.
pub const NOISE_PREFIX: &str = "noise.";

/// The parameter that a noise sd of a channel is inferred as: `noise.drawbar_pull_n`.
pub fn noise_parameter(channel: Channel) -> String {
    format!("{NOISE_PREFIX}{}", channel.column())
}

/// The base parameter behind a name: the name itself, or the part before a wheel's name.
///
/// # Errors
/// A sentence that names the unknown name and the nearest known one.
pub fn lookup(name: &str, wheels: &BTreeSet<&str>) -> Result<BaseParameter, String> {
    if let Some(whole) = EFFECTS.iter().chain(&SPATIAL).find(|p| p.name == name) {
        return Ok(*whole);
    }
    let (stem, wheel) = name
        .split_once('.')
        .map_or((name, None), |(stem, wheel)| (stem, Some(wheel)));
    let found = BASE.iter().find(|p| p.name == stem);
    match (found, wheel) {
        (Some(p), None) => Ok(*p),
        (Some(p), Some(w)) if p.name == "wheel_radius_m" => {
            if wheels.contains(w) {
                Ok(*p)
            } else {
                Err(unknown_word("wheel", w, wheels.iter().copied()))
            }
        }
        (Some(p), Some(_)) => Err(format!(
            "parameter {} belongs to the soil, not to one wheel: \"{name}\"",
            p.name
        )),
        (None, Some(_)) => Err(format!(
            "parameter \"{name}\" of an effect is not available in this version"
        )),
        (None, None) => {
            let known = BASE.iter().chain(&SPATIAL).map(|p| p.name);
            Err(unknown_word("parameter", name, known))
        }
    }
}

/// Checks one value against the physical bounds of its parameter.
///
/// # Errors
/// A sentence with the name, the value, the unit and the bound.
pub fn check_value(parameter: &BaseParameter, name: &str, value: f64) -> Result<(), String> {
    let BaseParameter {
        unit, lower, upper, ..
    } = *parameter;
    if !value.is_finite() {
        return Err(format!("{name} = {value} is not a finite number"));
    }
    if value < lower || value > upper {
        return Err(format!(
            "{name} = {value} {unit} lies outside [{lower}, {upper}] {unit}"
        ));
    }
    Ok(())
}

/// Checks that a set of names determines a model: one way to state the stiffness, `n` and the friction
/// angle present, no wheel radius given both for one wheel and for all.
///
/// # Errors
/// A sentence that names what is missing or said twice.
pub fn check_complete(names: &BTreeSet<&str>, wheels: &BTreeSet<&str>) -> Result<(), String> {
    for name in names {
        lookup(name, wheels)?;
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
    Ok(())
}

const BOTH_STIFFNESSES: &str = "the stiffness is given twice: k_c and k_phi exclude log10_p_ref and kappa";

#[cfg(test)]
mod tests {
    use super::*;

    fn check(names: &[&str]) -> Result<(), String> {
        check_complete(&names.iter().copied().collect(), &BTreeSet::from(["smooth"]))
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
        let error = lookup("wheel_radius_m.smoth", &BTreeSet::from(["smooth"])).unwrap_err();
        assert_eq!(error, "unknown wheel \"smoth\"; the nearest known is \"smooth\"");
    }

    #[test]
    fn a_parameter_of_an_effect_has_a_unit_and_a_bound() {
        let modulus = lookup(SHEAR_MODULUS, &BTreeSet::new()).unwrap();
        assert_eq!(
            check_value(&modulus, modulus.name, -0.01).unwrap_err(),
            "janosi_hanamoto.shear_modulus_m = -0.01 m lies outside [0, inf] m"
        );
        let error = lookup("bulldozing.share", &BTreeSet::new()).unwrap_err();
        assert!(error.contains("not available in this version"), "{error}");
    }

    #[test]
    fn a_value_outside_its_bounds_names_value_unit_and_bound() {
        let phi = lookup("friction_angle_deg", &BTreeSet::new()).unwrap();
        let error = check_value(&phi, phi.name, 95.0).unwrap_err();
        assert_eq!(error, "friction_angle_deg = 95 deg lies outside [0, 89] deg");
    }
}
