//! The table `[discovery]`: whether a study looks for the effects that its model misses, and adds them.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use shared::file::unknown_word;
use strum::VariantNames;

use super::algorithm_settings::AlgorithmSettings;
use super::candidate_priors;
use super::error::TableError;

/// Largest number of effects that a job may allow: as many as a model takes.
const MAX_EFFECTS: usize = 10;

/// The settings of the search for effects that a model misses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DiscoverySettings {
    /// Whether the program or the user decides on an extension.
    pub apply: Apply,
    /// Largest number of effects that are added to those of the job.
    pub max_effects: usize,
    /// Whether the other forward model is a candidate.
    pub other_kind: bool,
}

/// Who decides whether a missing effect is added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumString, strum::VariantNames)]
#[strum(serialize_all = "lowercase")]
pub enum Apply {
    /// Nobody: the study does not search for missing effects.
    Off,
    /// The user: the study ends with the effects that its search found.
    Ask,
    /// The study: it adds the effect that a search names, and searches again until none is named.
    Auto,
    /// The study, for the sake of predictions: where its search names no effect, it adds the leading candidate, too.
    Leading,
}

/// The search for a missing effect.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct RawDiscovery {
    /// Who decides whether a missing effect is added.
    #[schemars(extend("enum" = Apply::VARIANTS))]
    apply: String,
    /// Largest number of effects that `"auto"` and `"leading"` add.
    #[schemars(range(min = 1, max = MAX_EFFECTS))]
    max_effects: usize,
    /// Whether the other kind of model is a candidate too.
    other_kind: bool,
    /// Files of effects that are candidates beside the catalogue.
    #[schemars(extend("uniqueItems" = true))]
    pub(crate) candidate_files: Vec<String>,
    #[schemars(with = "Value")]
    pub(crate) priors: toml::Table,
}

impl Default for RawDiscovery {
    fn default() -> Self {
        RawDiscovery {
            apply: "off".into(),
            max_effects: 3,
            other_kind: false,
            candidate_files: Vec::new(),
            priors: toml::Table::new(),
        }
    }
}

impl RawDiscovery {
    /// Returns the settings of a job with this algorithm.
    pub(crate) fn settings(&self, algorithm: &AlgorithmSettings) -> Result<DiscoverySettings, TableError> {
        let max_effects = self.max_effects;
        if !(1..=MAX_EFFECTS).contains(&max_effects) {
            let rule = format!("must lie in [1, {MAX_EFFECTS}]");
            return Err(TableError::value("max_effects", max_effects, rule));
        }
        let known = || Apply::VARIANTS.iter().copied();
        let unknown = |_| TableError::Unknown(unknown_word("value of apply", &self.apply, known()));
        let apply = self.apply.parse().map_err(unknown)?;
        if apply != Apply::Off && !algorithm.has_posterior() {
            return Err(TableError::NoLedger {
                apply: self.apply.clone(),
                algorithm: algorithm.name(),
            });
        }
        candidate_priors::check(&self.priors)?;
        Ok(DiscoverySettings {
            apply,
            max_effects,
            other_kind: self.other_kind,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Job;

    fn parse(sampler: &str, discovery: &str) -> Result<DiscoverySettings, String> {
        let job = format!("[model]\nkind = \"scm\"\n[sampler]\n{sampler}\n{discovery}\n");
        Job::parse("job.toml", &job)
            .map(|job| job.discovery)
            .map_err(|e| e.to_string())
    }

    #[test]
    fn a_job_says_who_decides() {
        let settings = |apply, max_effects| {
            Ok(DiscoverySettings {
                apply,
                max_effects,
                other_kind: false,
            })
        };
        assert_eq!(parse("", ""), settings(Apply::Off, 3));
        assert_eq!(parse("", "[discovery]\napply = \"ask\""), settings(Apply::Ask, 3));
        assert_eq!(
            parse("", "[discovery]\napply = \"auto\"\nmax_effects = 10"),
            settings(Apply::Auto, 10)
        );
        let leading = parse("", "[discovery]\napply = \"leading\"");
        assert_eq!(leading, settings(Apply::Leading, 3));
    }

    #[test]
    fn what_means_nothing_is_refused() {
        for (sampler, table, reason) in [
            (
                "",
                "apply = \"aut\"",
                "unknown value of apply \"aut\"; the nearest known is \"auto\"",
            ),
            ("", "max_effects = 0", "max_effects = 0 must lie in [1, 10]"),
            ("", "max_effects = 11", "max_effects = 11 must lie in [1, 10]"),
            (
                "algorithm = \"lm\"\nparticles = 0",
                "apply = \"ask\"",
                "apply = \"ask\" needs a posterior: lm without draws keeps no ledger",
            ),
        ] {
            let error = parse(sampler, &format!("[discovery]\n{table}")).unwrap_err();
            assert!(error.contains(&format!("[discovery] {reason}")), "{error}");
        }
    }
}
