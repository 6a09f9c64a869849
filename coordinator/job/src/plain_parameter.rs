//! Parameters of the model that a job holds fixed and a search may free: candidates, as effects are.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use shared::parameters::model_parameters;
use statistics::Marginal;

use crate::spec::Spec;
use crate::table::prior_entry::marginal;

/// A parameter of the model that a search may free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlainParameter {
    /// Name in jobs.
    pub name: &'static str,
    /// A sentence that states the assumption if the parameter has another value.
    pub summary: &'static str,
    /// Prior of the freed parameter, as in a job.
    pub prior: &'static str,
    /// The effect that is the same parameter in another unit, and is the candidate in its place.
    pub covered_by: Option<&'static str>,
}

const fn plain(name: &'static str, prior: &'static str, summary: &'static str) -> PlainParameter {
    PlainParameter {
        name,
        summary,
        prior,
        covered_by: None,
    }
}

/// The parameters that a search may free.
///
/// Priors: cohesion of dry and slightly moist sand; exponents from an even to a triangular distribution of the pressure; a factor of e
/// and of 3 about the model's velocity and stiffness; shares anywhere.
pub const PLAIN_PARAMETERS: [PlainParameter; 6] = [
    plain(
        "cohesion_pa",
        "{ half_normal = 500.0 }",
        "the soil has a cohesion other than the job says",
    ),
    plain(
        "gamma_exponent",
        "{ uniform = [0.0, 1.0] }",
        "the pressure falls off towards the border of the footprint by another power",
    ),
    PlainParameter {
        covered_by: Some("shear_velocity_scale"),
        ..plain(
            "shear_velocity_m_s",
            "{ lognormal = [0.001, 2.718281828459045] }",
            "the reference velocity of the shear law is another",
        )
    },
    plain(
        "elastic_stiffness_pa_m",
        "{ lognormal = [1e9, 3.0] }",
        "the soil has another elastic stiffness than the job says",
    ),
    plain(
        "flow_fraction",
        "{ uniform = [0.0, 1.0] }",
        "another share of the pressed soil flows to the border of the footprint",
    ),
    plain(
        "bearing_credit",
        "{ uniform = [0.0, 1.0] }",
        "soil that has flowed carries another share of what settled soil does",
    ),
];

/// The priors of these parameters by name, parsed once.
static PRIORS: LazyLock<BTreeMap<&'static str, (toml::Value, Marginal)>> = LazyLock::new(|| {
    let prior = |plain: &PlainParameter| Some((plain.name, plain.read_prior()?));
    PLAIN_PARAMETERS.iter().filter_map(prior).collect()
});

impl PlainParameter {
    /// Returns the parameter of a name, if a search may free it.
    pub fn find(name: &str) -> Option<&'static Self> {
        PLAIN_PARAMETERS.iter().find(|plain| plain.name == name)
    }

    /// Returns the name of the candidate that gives it another value: its own, or that of the effect in its place.
    pub fn candidate(&self) -> &'static str {
        self.covered_by.unwrap_or(self.name)
    }

    /// Returns the prior as a value of TOML, and as a density.
    pub fn prior(&self) -> Option<&'static (toml::Value, Marginal)> {
        PRIORS.get(self.name)
    }

    fn read_prior(&self) -> Option<(toml::Value, Marginal)> {
        let value: toml::Value = self.prior.parse().ok()?;
        let parameter = model_parameters().find(|p| p.name == self.name)?;
        let density = marginal(&value, &parameter.into()).ok()?;
        Some((value, density))
    }

    /// Returns the value at which a job holds the parameter, with the density of its prior; `None` if it is free, if the model does not
    /// have it, if its value lies outside its prior, or if an effect is the candidate in its place.
    pub fn held_by(&self, spec: &Spec) -> Option<(f64, Marginal)> {
        let is_free = spec.parameters.iter().any(|p| p.name == self.name);
        let parameter = match &spec.model.external {
            None => spec.model.kind.parameters().find(|p| p.name == self.name)?,
            Some(model) if model.shares(self.name) => model_parameters().find(|p| p.name == self.name)?,
            Some(_) => return None,
        };
        if is_free || self.covered_by.is_some() || spec.fit_variant.conditions.is_empty() {
            return None;
        }
        let value = spec.model.fixed.get(self.name).copied().or(parameter.default)?;
        let (_, density) = self.prior()?;
        let (lower, upper) = density.support();
        (lower..=upper).contains(&value).then(|| (value, density.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_priors_knows_their_names() {
        assert_eq!(
            PLAIN_PARAMETERS.map(|plain| plain.name),
            crate::table::candidate_priors::PLAIN
        );
    }

    #[test]
    fn every_one_is_a_parameter_whose_default_its_prior_holds() {
        for plain in &PLAIN_PARAMETERS {
            let (_, density) = plain.prior().unwrap_or_else(|| panic!("{}", plain.name));
            let parameter = model_parameters().find(|p| p.name == plain.name).unwrap();
            let (lower, upper) = density.support();
            assert!(
                (lower..=upper).contains(&parameter.default.unwrap()),
                "{}",
                plain.name
            );
            assert!(
                plain
                    .covered_by
                    .is_none_or(|effect| formula::catalogue::find(effect).is_some())
            );
        }
    }
}
