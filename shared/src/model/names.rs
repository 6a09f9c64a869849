//! What parameter names mean, and whether a set of them determines a model.

use std::collections::BTreeSet;

use super::effects::EffectSet;
use super::error::ModelError;
use super::external::ExternalModel;
use crate::file::unknown_word;
use crate::parameters::{BASE, ParameterBounds, RING_TRANSFER, SPATIAL};

/// What gives the names of parameters their meaning.
#[derive(Debug, Clone, Copy)]
pub struct ParameterScope<'a> {
    /// The wheels of the experiment.
    pub wheels: &'a BTreeSet<&'a str>,
    /// The effects of the job.
    pub effects: &'a EffectSet,
    /// The model, where it is not ours: then it has its own parameters.
    pub external: Option<&'a ExternalModel>,
}

impl ParameterScope<'_> {
    /// A parameter of the model itself.
    fn of_model(&self, name: &str) -> Option<ParameterBounds> {
        let Some(model) = self.external else {
            let mut ours = BASE.iter().chain(&SPATIAL);
            return ours.find(|p| p.name == name).map(ParameterBounds::from);
        };
        // the radius of the rim, in place of the experiment's
        let radius = BASE.iter().filter(|p| p.name == RADIUS);
        let mut radius = radius.filter(|p| p.name == name).map(ParameterBounds::from);
        let own = model.parameter(name).map(|parameter| parameter.bounds());
        own.or_else(|| radius.next())
    }

    fn unknown(&self, name: &str) -> ModelError {
        let known: Vec<&str> = match self.external {
            None => BASE.iter().chain(&SPATIAL).map(|p| p.name).collect(),
            Some(model) => model.parameters.iter().map(|p| p.name.as_str()).collect(),
        };
        ModelError::Unknown(unknown_word("parameter", name, known))
    }
}

/// The parameter that one wheel of several may have for itself.
const RADIUS: &str = "wheel_radius_m";

/// Unit and bounds of a parameter by name: of the model, of one of its wheels, of an effect.
///
/// # Errors
/// [`ModelError`] names the unknown name and the nearest known one.
pub fn lookup(name: &str, scope: &ParameterScope) -> Result<ParameterBounds, ModelError> {
    let wheels = scope.wheels;
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
    match (scope.of_model(stem), wheel) {
        (Some(found), None) => Ok(found),
        (Some(found), Some(w)) if stem == RADIUS => {
            if wheels.contains(w) {
                Ok(found)
            } else {
                let known = wheels.iter().copied();
                Err(ModelError::Unknown(unknown_word("wheel", w, known)))
            }
        }
        (Some(_), Some(_)) => Err(ModelError::Invalid(format!(
            "parameter {stem} belongs to the soil, not to one wheel: \"{name}\""
        ))),
        (None, _) => {
            let of_effect = scope.effects.lookup(name, wheels);
            of_effect.unwrap_or_else(|| Err(scope.unknown(name)))
        }
    }
}

/// Checks that a set of names determines a model.
///
/// One way to state the stiffness, `n` and the friction angle present, or all parameters of a model that is not ours; every parameter of
/// every effect given, nothing given both for one wheel and for all.
///
/// # Errors
/// [`ModelError`] names what is missing or given twice.
pub fn check_complete(names: &BTreeSet<&str>, scope: &ParameterScope) -> Result<(), ModelError> {
    for name in names {
        lookup(name, scope)?;
    }
    match scope.external {
        None => check_soil(names)?,
        Some(model) => {
            let mut own = model.parameters.iter();
            if let Some(unset) = own.find(|p| !names.contains(p.name.as_str())) {
                return Err(ModelError::Unset(unset.name.clone()));
            }
        }
    }
    let per_wheel = names.iter().any(|n| n.starts_with("wheel_radius_m."));
    if names.contains(RADIUS) && per_wheel {
        let message = "wheel_radius_m is given both for all wheels and for one wheel";
        return Err(ModelError::Incomplete(message.to_owned()));
    }
    scope.effects.check_complete(names, scope.wheels)
}

/// Checks that names determine the soil of our models.
fn check_soil(names: &BTreeSet<&str>) -> Result<(), ModelError> {
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
    Ok(())
}

const BOTH_STIFFNESSES: &str = "the stiffness is given twice: k_c and k_phi exclude log10_p_ref and kappa";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::check_value;

    fn scope<'a>(wheels: &'a BTreeSet<&'a str>, effects: &'a EffectSet) -> ParameterScope<'a> {
        ParameterScope {
            wheels,
            effects,
            external: None,
        }
    }

    fn check(names: &[&str]) -> Result<(), ModelError> {
        let (wheels, none) = (BTreeSet::from(["smooth"]), EffectSet::default());
        check_complete(&names.iter().copied().collect(), &scope(&wheels, &none))
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
            &scope(&BTreeSet::from(["smooth"]), &EffectSet::default()),
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
        let lookup = |name: &str| lookup(name, &scope(&BTreeSet::from(["w"]), &effects));
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
        let (wheels, none) = (BTreeSet::new(), EffectSet::default());
        let phi = lookup("friction_angle_deg", &scope(&wheels, &none)).unwrap();
        let error = check_value(&phi, "friction_angle_deg", 95.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "friction_angle_deg = 95 deg lies outside [0, 89] deg"
        );
        let n = lookup("n", &scope(&wheels, &none)).unwrap();
        let error = check_value(&n, "n", -1.0).unwrap_err();
        assert_eq!(error.to_string(), "n = -1 lies outside [0.01, 10]");
    }
}
