//! The meaning of parameter names, and the check that a set of them determines a model.

use std::collections::BTreeSet;

use super::effects::EffectSet;
use super::error::ModelError;
use super::external::ExternalModel;
use super::kind::ModelKind;
use crate::file::unknown_word;
use crate::parameters::{BASE, ParameterBounds, RING_TRANSFER, SPATIAL, WHEEL_RADIUS, model_parameters};

/// The objects that give parameter names their meaning.
#[derive(Debug, Clone, Copy)]
pub struct ParameterScope<'a> {
    /// The wheels of the experiment.
    pub wheels: &'a BTreeSet<&'a str>,
    /// The effects of the job.
    pub effects: &'a EffectSet,
    /// The external model, which brings its parameters; `None` for a built-in model.
    pub external: Option<&'a ExternalModel>,
}

impl ParameterScope<'_> {
    /// Finds a parameter of the model itself.
    fn model_parameter(&self, name: &str) -> Option<ParameterBounds> {
        let Some(model) = self.external else {
            return model_parameters()
                .find(|p| p.name == name)
                .map(ParameterBounds::from);
        };
        // A parameter may replace the radius that the experiment states.
        let radius = BASE.iter().filter(|p| p.name == WHEEL_RADIUS);
        let mut radius = radius.filter(|p| p.name == name).map(ParameterBounds::from);
        let declared = model.parameter(name).map(|parameter| parameter.bounds());
        declared.or_else(|| radius.next())
    }

    fn unknown(&self, name: &str) -> ModelError {
        let names: Vec<&str> = match self.external {
            None => model_parameters().map(|p| p.name).collect(),
            Some(model) => model.parameters.iter().map(|p| p.name.as_str()).collect(),
        };
        ModelError::Unknown(unknown_word("parameter", name, names))
    }
}

/// Returns the unit and bounds of a parameter of the model, of one of its wheels or of an effect, by name.
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
    match (scope.model_parameter(stem), wheel) {
        (Some(bounds), None) => Ok(bounds),
        (Some(bounds), Some(w)) if stem == WHEEL_RADIUS => {
            if wheels.contains(w) {
                Ok(bounds)
            } else {
                let names = wheels.iter().copied();
                Err(ModelError::Unknown(unknown_word("wheel", w, names)))
            }
        }
        (Some(_), Some(_)) => Err(ModelError::Invalid(format!(
            "parameter {stem} belongs to the soil, not to one wheel: \"{name}\""
        ))),
        (None, _) => {
            let bounds = scope.effects.lookup(name, wheels);
            bounds.unwrap_or_else(|| Err(scope.unknown(name)))
        }
    }
}

/// Checks that a set of names determines a model; [`ModelError`] names a parameter that is missing, stated twice or of
/// another model.
///
/// Required are one way to state the stiffness, `n` and the friction angle if the model has them, its further parameters, and
/// every parameter of every effect; nothing may be stated both for one wheel and for all.
pub fn check_complete(
    kind: ModelKind,
    names: &BTreeSet<&str>,
    scope: &ParameterScope,
) -> Result<(), ModelError> {
    for name in names {
        lookup(name, scope)?;
        if scope.external.is_none() {
            check_kind(kind, name)?;
        }
    }
    match scope.external {
        None => check_soil(kind, names)?,
        Some(model) => {
            let mut parameters = model.parameters.iter();
            if let Some(unset) = parameters.find(|p| !names.contains(p.name.as_str())) {
                return Err(ModelError::Unset(unset.name.clone()));
            }
        }
    }
    let per_wheel = names.iter().any(|n| n.starts_with("wheel_radius_m."));
    if names.contains(WHEEL_RADIUS) && per_wheel {
        let message = "wheel_radius_m is given both for all wheels and for one wheel";
        return Err(ModelError::Incomplete(message.to_owned()));
    }
    scope.effects.check_complete(names, scope.wheels)
}

/// Checks that names determine the soil of a built-in model.
fn check_soil(kind: ModelKind, names: &BTreeSet<&str>) -> Result<(), ModelError> {
    let incomplete = |message: &str| Err(ModelError::Incomplete(message.to_owned()));
    let has = |name| names.contains(name);
    if let Some(unset) = kind.parameters().find(|p| p.prior.is_some() && !has(p.name)) {
        return Err(ModelError::Unset(unset.name.to_owned()));
    }
    let stiffness = (has("k_c") && has("k_phi"), has("log10_p_ref") && has("kappa"));
    match stiffness {
        _ if !kind.has_soil_laws() => {}
        (true, false) if has("log10_p_ref") || has("kappa") => return incomplete(BOTH_STIFFNESSES),
        (false, true) if has("k_c") || has("k_phi") => return incomplete(BOTH_STIFFNESSES),
        (true, true) => return incomplete(BOTH_STIFFNESSES),
        (false, false) => return incomplete("the stiffness needs k_c and k_phi, or log10_p_ref and kappa"),
        _ => {}
    }
    for name in ["n", "friction_angle_deg"] {
        if kind.has_soil_laws() && !has(name) {
            return Err(ModelError::Unset(name.to_owned()));
        }
    }
    Ok(())
}

/// Checks that a base parameter belongs to the model; terrain parameters are refused elsewhere, where it is known whether a
/// wheel rolls.
fn check_kind(kind: ModelKind, name: &str) -> Result<(), ModelError> {
    let stem = name.split_once('.').map_or(name, |(stem, _)| stem);
    let is_base = model_parameters().any(|p| p.name == stem) && SPATIAL.iter().all(|p| p.name != stem);
    if !is_base || kind.parameters().any(|p| p.name == stem) {
        return Ok(());
    }
    let having = ModelKind::ALL
        .iter()
        .filter(|kind| kind.parameters().any(|p| p.name == stem));
    let having: Vec<&str> = having.map(|kind| kind.name()).collect();
    let names: Vec<&str> = kind.parameters().map(|p| p.name).collect();
    Err(ModelError::Inexpressible(format!(
        "{name} is a parameter of {}, not of {}, which has {}",
        having.join(", "),
        kind.name(),
        names.join(", ")
    )))
}

const BOTH_STIFFNESSES: &str = "the stiffness is given twice: k_c and k_phi exclude log10_p_ref and kappa";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_table::cases;
    use crate::parameters::check_value;

    fn scope<'a>(wheels: &'a BTreeSet<&'a str>, effects: &'a EffectSet) -> ParameterScope<'a> {
        ParameterScope {
            wheels,
            effects,
            external: None,
        }
    }

    fn check(kind: ModelKind, names: &str) -> Result<(), String> {
        let (wheels, none) = (BTreeSet::from(["smooth"]), EffectSet::default());
        let names = names.split(' ').collect();
        check_complete(kind, &names, &scope(&wheels, &none)).map_err(|e| e.to_string())
    }

    #[test]
    fn a_model_needs_exactly_its_parameters() {
        let rft = "surface_friction wheel_radius_m.smooth";
        assert_eq!(check(ModelKind::Rft, &format!("xi_n_pa_m {rft}")), Ok(()));
        let laws = "k_c k_phi n friction_angle_deg c1 c2";
        for (kind, names, message) in [
            (
                ModelKind::Rft,
                rft,
                "parameter xi_n_pa_m has neither a prior nor a fixed value",
            ),
            (
                ModelKind::Rft,
                "n xi_n_pa_m surface_friction",
                "n is a parameter of quasi_static, scm, wong_reece, not of rft, which has wheel_radius_m, xi_n_pa_m, surface_friction",
            ),
            (
                ModelKind::WongReece,
                laws,
                "parameter shear_modulus_m has neither a prior nor a fixed value",
            ),
            (
                ModelKind::QuasiStatic,
                laws,
                "c1 is a parameter of wong_reece, not of quasi_static",
            ),
        ] {
            let refused = check(kind, names).unwrap_err();
            assert!(refused.starts_with(message), "{refused}");
        }
    }

    #[test]
    fn either_stiffness_is_complete_and_both_are_refused() {
        let with = |names| check(ModelKind::QuasiStatic, &format!("{names} n friction_angle_deg"));
        assert_eq!(with("k_c k_phi"), Ok(()));
        assert_eq!(with("log10_p_ref kappa"), Ok(()));
        assert!(with("k_c k_phi kappa").unwrap_err().contains("twice"));
        assert!(with("k_c").unwrap_err().contains("needs"));
    }

    #[test]
    fn a_radius_of_an_unknown_wheel_names_the_nearest() {
        let (wheels, none) = (BTreeSet::from(["smooth"]), EffectSet::default());
        let error = lookup("wheel_radius_m.smoth", &scope(&wheels, &none)).unwrap_err();
        let message = "unknown wheel \"smoth\"; the nearest known is \"smooth\"";
        assert_eq!(error.to_string(), message);
    }

    #[test]
    fn a_parameter_of_an_effect_has_a_unit_and_a_bound() {
        let name = "janosi_hanamoto.shear_modulus_m";
        let effects = EffectSet::choose("job.toml", (&[], &[]), [name], |_| None).unwrap();
        let lookup = |name: &str| lookup(name, &scope(&BTreeSet::from(["w"]), &effects));
        let outside = check_value(&lookup(name).unwrap(), name, -0.01).unwrap_err();
        let message = "janosi_hanamoto.shear_modulus_m = -0.01 m lies outside [0, inf] m";
        assert_eq!(outside.to_string(), message);
        assert_eq!(lookup("janosi_hanamoto.shear_modulus_m.w").unwrap().unit, "m");
        for (name, message) in cases(
            r#"
            janosi_hanamoto.shear_modulus => unknown parameter of effect janosi_hanamoto "shear_modulus"; the nearest known is "shear_modulus_m"
            buldozing.scale => unknown effect "buldozing"; the nearest known is "bulldozing""#,
        ) {
            assert_eq!(lookup(name).unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn a_value_outside_its_bounds_names_value_unit_and_bound() {
        let (wheels, none) = (BTreeSet::new(), EffectSet::default());
        for (name, value, message) in [
            (
                "friction_angle_deg",
                95.0,
                "friction_angle_deg = 95 deg lies outside [0, 89] deg",
            ),
            ("n", -1.0, "n = -1 lies outside [0.01, 10]"),
        ] {
            let bounds = lookup(name, &scope(&wheels, &none)).unwrap();
            let error = check_value(&bounds, name, value).unwrap_err();
            assert_eq!(error.to_string(), message);
        }
    }
}
