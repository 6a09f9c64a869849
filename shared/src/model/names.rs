//! What parameter names mean, and whether a set of them determines a model.

use std::collections::BTreeSet;

use super::effects::EffectSet;
use super::error::ModelError;
use crate::file::unknown_word;
use crate::parameters::{BASE, ParameterBounds, RING_TRANSFER, SPATIAL};

/// Unit and bounds of a parameter by name: of the model, of one of its wheels, of an effect.
///
/// # Errors
/// [`ModelError`] names the unknown name and the nearest known one.
pub fn lookup(
    name: &str,
    wheels: &BTreeSet<&str>,
    effects: &EffectSet,
) -> Result<ParameterBounds, ModelError> {
    if name == RING_TRANSFER {
        return Ok(ParameterBounds {
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
                let known = wheels.iter().copied();
                Err(ModelError::Unknown(unknown_word("wheel", w, known)))
            }
        }
        (Some(p), Some(_)) => Err(ModelError::Invalid(format!(
            "parameter {} belongs to the soil, not to one wheel: \"{name}\"",
            p.name
        ))),
        (None, _) => effects.lookup(name, wheels).unwrap_or_else(|| {
            let known = BASE.iter().chain(&SPATIAL).map(|p| p.name);
            Err(ModelError::Unknown(unknown_word("parameter", name, known)))
        }),
    }
}

/// Checks that a set of names determines a model: one way to state the stiffness, `n` and the friction
/// angle present, every parameter of every effect given, nothing given both for one wheel and for all.
///
/// # Errors
/// [`ModelError`] names what is missing or given twice.
pub fn check_complete(
    names: &BTreeSet<&str>,
    wheels: &BTreeSet<&str>,
    effects: &EffectSet,
) -> Result<(), ModelError> {
    for name in names {
        lookup(name, wheels, effects)?;
    }
    let incomplete = |message: &str| Err(ModelError::Incomplete(message.to_owned()));
    let has = |name| names.contains(name);
    match (has("k_c") && has("k_phi"), has("log10_p_ref") && has("kappa")) {
        (true, false) if has("log10_p_ref") || has("kappa") => return incomplete(BOTH_STIFFNESSES),
        (false, true) if has("k_c") || has("k_phi") => return incomplete(BOTH_STIFFNESSES),
        (true, true) => return incomplete(BOTH_STIFFNESSES),
        (false, false) => return incomplete("the stiffness needs k_c and k_phi, or log10_p_ref and kappa"),
        _ => {}
    }
    for name in ["n", "friction_angle_deg"] {
        if !has(name) {
            return Err(ModelError::Unset(name.to_owned()));
        }
    }
    let per_wheel = names.iter().any(|n| n.starts_with("wheel_radius_m."));
    if has("wheel_radius_m") && per_wheel {
        return incomplete("wheel_radius_m is given both for all wheels and for one wheel");
    }
    effects.check_complete(names, wheels)
}

const BOTH_STIFFNESSES: &str = "the stiffness is given twice: k_c and k_phi exclude log10_p_ref and kappa";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::check_value;

    fn check(names: &[&str]) -> Result<(), ModelError> {
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
                .to_string()
                .contains("twice")
        );
        assert!(
            check(&["k_c", "n", "friction_angle_deg"])
                .unwrap_err()
                .to_string()
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
        assert_eq!(
            error.to_string(),
            "unknown wheel \"smoth\"; the nearest known is \"smooth\""
        );
    }

    #[test]
    fn a_parameter_of_an_effect_has_a_unit_and_a_bound() {
        let name = "janosi_hanamoto.shear_modulus_m";
        let effects = EffectSet::choose("job.toml", (&[], &[]), [name], &Default::default()).unwrap();
        let lookup = |name: &str| lookup(name, &BTreeSet::from(["w"]), &effects);
        assert_eq!(
            check_value(&lookup(name).unwrap(), name, -0.01)
                .unwrap_err()
                .to_string(),
            "janosi_hanamoto.shear_modulus_m = -0.01 m lies outside [0, inf] m"
        );
        assert_eq!(lookup("janosi_hanamoto.shear_modulus_m.w").unwrap().unit, "m");
        assert_eq!(
            lookup("janosi_hanamoto.shear_modulus").unwrap_err().to_string(),
            "unknown parameter of effect janosi_hanamoto \"shear_modulus\"; the nearest known is \"shear_modulus_m\""
        );
        assert_eq!(
            lookup("buldozing.scale").unwrap_err().to_string(),
            "unknown effect \"buldozing\"; the nearest known is \"bulldozing\""
        );
    }

    #[test]
    fn a_value_outside_its_bounds_names_value_unit_and_bound() {
        let phi = lookup("friction_angle_deg", &BTreeSet::new(), &EffectSet::default()).unwrap();
        let error = check_value(&phi, "friction_angle_deg", 95.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "friction_angle_deg = 95 deg lies outside [0, 89] deg"
        );
        let n = lookup("n", &BTreeSet::new(), &EffectSet::default()).unwrap();
        let error = check_value(&n, "n", -1.0).unwrap_err();
        assert_eq!(error.to_string(), "n = -1 lies outside [0.01, 10]");
    }
}
