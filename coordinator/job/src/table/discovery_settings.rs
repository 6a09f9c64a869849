//! The table `[discovery]`: whether a study looks for the effects that its model misses, and adds them.

use serde::Deserialize;
use shared::file::unknown_word;

use super::algorithm_settings::AlgorithmSettings;
use super::candidate_priors;
use super::error::TableError;

/// Largest number of effects that a job may allow: as many as a model takes.
const MAX_EFFECTS: usize = 10;

/// The settings of the search for effects that a model misses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DiscoverySettings {
    /// Who decides.
    pub apply: Apply,
    /// Largest number of effects that are added to those of the job.
    pub max_effects: usize,
    /// Whether the other forward model is a candidate.
    pub other_kind: bool,
}

/// Who decides whether a missing effect is added.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Apply {
    /// Nobody: it is not looked for.
    Off,
    /// The user: it is looked for, and the study ends with what was found.
    Ask,
    /// The study: what is named is added, until nothing more is.
    Auto,
}

/// The table as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct RawDiscovery {
    apply: String,
    max_effects: usize,
    other_kind: bool,
    pub(crate) priors: toml::Table,
}

impl Default for RawDiscovery {
    fn default() -> Self {
        RawDiscovery {
            apply: "off".into(),
            max_effects: 3,
            other_kind: false,
            priors: toml::Table::new(),
        }
    }
}

impl RawDiscovery {
    /// The settings of a job with this algorithm.
    pub(crate) fn settings(&self, algorithm: &AlgorithmSettings) -> Result<DiscoverySettings, TableError> {
        let max_effects = self.max_effects;
        if !(1..=MAX_EFFECTS).contains(&max_effects) {
            let rule = format!("must lie in [1, {MAX_EFFECTS}]");
            return Err(TableError::value("max_effects", max_effects, rule));
        }
        let apply = match self.apply.as_str() {
            "off" => Apply::Off,
            "ask" => Apply::Ask,
            "auto" => Apply::Auto,
            other => {
                let unknown = unknown_word("value of apply", other, ["off", "ask", "auto"]);
                return Err(TableError::Unknown(unknown));
            }
        };
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
