//! Single facts that texts state, for lists and migrations: the texts need not be valid jobs or effects.

use std::collections::BTreeSet;

use formula::catalogue::find;
use shared::model::ModelKind;

use crate::table::algorithm_settings::AlgorithmName;

/// Returns the kind of a job's first model; `None` if this version has no such kind.
pub fn model_kind(toml: &str) -> Option<ModelKind> {
    let job: toml::Table = toml.parse().ok()?;
    let first = || job.get("models")?.as_array()?.first();
    let model = job.get("model").or_else(first)?;
    model.get("kind")?.clone().try_into().ok()
}

/// Returns the name that an effect file gives its effect.
pub fn effect_name(text: &str) -> Option<String> {
    let file: toml::Table = text.parse().ok()?;
    Some(file.get("name")?.as_str()?.to_owned())
}

/// Returns whether a job is a search as versions before migration 20 stored it, with `algorithm = "discovery"`. Only the store reads these, to
/// learn which calibration was searched.
pub fn is_earlier_search(toml: &str) -> bool {
    let job: Option<toml::Table> = toml.parse().ok();
    let sampler = job.as_ref().and_then(|job| job.get("sampler"));
    let algorithm = sampler.and_then(|sampler| sampler.get("algorithm")?.as_str());
    algorithm == Some(AlgorithmName::Discovery.name())
}

/// Returns the effects that a job lists and the program's catalogue lacks. A text that is no job lists none: its reader says what is wrong
/// with it.
pub fn foreign_effects(toml: &str) -> BTreeSet<String> {
    let names = |toml: &str| -> Option<BTreeSet<String>> {
        let job: toml::Table = toml.parse().ok()?;
        let listed = job.get("model")?.get("effects")?.clone();
        let listed: Vec<String> = listed.try_into().ok()?;
        Some(listed.into_iter().filter(|name| find(name).is_none()).collect())
    };
    names(toml).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_job_lists_nothing() {
        for text in ["", "[model", "[model]\neffects = 3\n", "model = 1\n"] {
            assert!(foreign_effects(text).is_empty(), "{text}");
        }
    }
}
