//! The table `[discovery.priors]`: priors of parameters that a search may add.

use std::collections::BTreeMap;

use formula::catalogue::catalogue;
use shared::file::unknown_word;
use shared::model::effects::parameter_name;
use shared::parameters::ParameterBounds;

use super::error::TableError;
use super::prior_entry::marginal;
use super::prior_entry_error::PriorEntryError;

/// Names of the parameters of the model that a search may free, as in [`PlainParameter`](crate::PlainParameter).
pub(crate) const PLAIN: [&str; 6] = [
    "cohesion_pa",
    "gamma_exponent",
    "shear_velocity_m_s",
    "elastic_stiffness_pa_m",
    "flow_fraction",
    "bearing_credit",
];

/// Returns the table of a job's text by the full names of the parameters; empty if there is none.
pub fn candidate_priors(toml: &str) -> BTreeMap<String, toml::Value> {
    let job: Option<toml::Table> = toml.parse().ok();
    let table = job
        .as_ref()
        .and_then(|job| job.get("discovery")?.get("priors")?.as_table());
    table.map_or(BTreeMap::new(), by_name)
}

/// Returns the entries by full names: TOML reads a dotted key without quotes as a table under the effect's name.
pub(crate) fn by_name(table: &toml::Table) -> BTreeMap<String, toml::Value> {
    let mut named = BTreeMap::new();
    for (key, value) in table {
        match value.as_table() {
            Some(table) if !key.contains('.') && !PLAIN.contains(&key.as_str()) => {
                named.extend(
                    table
                        .iter()
                        .map(|(name, value)| (format!("{key}.{name}"), value.clone())),
                );
            }
            _ => {
                named.insert(key.clone(), value.clone());
            }
        }
    }
    named
}

/// Checks that each prior is one of a parameter that a search may add.
pub(super) fn check(table: &toml::Table) -> Result<(), TableError> {
    let effect_parameters = catalogue().iter().flat_map(|effect| {
        effect
            .parameters
            .iter()
            .map(move |p| parameter_name(effect, p, None))
    });
    let known: Vec<String> = effect_parameters.chain(PLAIN.map(String::from)).collect();
    for (name, value) in by_name(table) {
        if !known.contains(&name) {
            let names = known.iter().map(String::as_str);
            return Err(TableError::Unknown(unknown_word(
                "parameter of a candidate",
                &name,
                names,
            )));
        }
        let unbounded = ParameterBounds {
            unit: String::new(),
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
        };
        let fail =
            |e: PriorEntryError| TableError::Unknown(e.in_parameter(format!("priors: {name}")).to_string());
        marginal(&value, &unbounded).map_err(fail)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_and_dotted_keys_name_the_same_parameters() {
        let quoted = "[discovery.priors]\n\"slip_sinkage.exponent_per_slip\" = { half_normal = 2.0 }\ncohesion_pa = { half_normal = 50.0 }\n";
        let dotted = "[discovery]\napply = \"ask\"\n[discovery.priors]\nslip_sinkage.exponent_per_slip = { half_normal = 2.0 }\ncohesion_pa = { half_normal = 50.0 }\n";
        let names: Vec<String> = candidate_priors(quoted).into_keys().collect();
        assert_eq!(names, ["cohesion_pa", "slip_sinkage.exponent_per_slip"]);
        assert_eq!(candidate_priors(quoted), candidate_priors(dotted));
        assert!(candidate_priors("[discovery]\napply = \"ask\"\n").is_empty());
    }

    #[test]
    fn only_priors_of_candidates_are_taken() {
        let check = |line: &str| check(&line.parse().unwrap()).map_err(|e| e.to_string());
        assert_eq!(
            check(
                "\"slip_sinkage.exponent_per_slip\" = { half_normal = 2.0 }\ncohesion_pa = { half_normal = 50.0 }"
            ),
            Ok(())
        );
        let error = check("\"slip_sinkage.exponent_per_slp\" = { half_normal = 2.0 }").unwrap_err();
        assert!(error.contains("slip_sinkage.exponent_per_slip"), "{error}");
        let error = check("\"slip_sinkage.exponent_per_slip\" = { half_normal = -2.0 }").unwrap_err();
        assert!(
            error.contains("priors: slip_sinkage.exponent_per_slip"),
            "{error}"
        );
    }
}
