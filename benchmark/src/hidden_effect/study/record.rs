//! A search as the farm runs it, with the record that a study stores.

use std::collections::BTreeMap;

use coordinator::embedded::Evaluate;
use record::{Discovery, NONE, Verdict};
use search::{RunningDiscovery, SearchModels};
use shared::file::FileSet;
use shared::outcome::Outcome;

use crate::error::StudyError;
use crate::parallel::each_on;

/// Searches for the effects that the model is missing.
///
/// # Arguments
/// - `max_effects`: the largest number of effects in a combination. `threads`: the threads that share the evaluations of a round.
pub fn record(
    job: &FileSet,
    experiment: &FileSet,
    max_effects: usize,
    threads: usize,
) -> Result<Discovery, StudyError> {
    let mut search = RunningDiscovery::new(SearchModels::new(job, experiment, max_effects)?)?;
    let mut evaluates: BTreeMap<String, Evaluate> = BTreeMap::new();
    loop {
        if let Some(record) = search.record() {
            return Ok(record);
        }
        let asked: Vec<usize> = search.pending().iter().map(|query| query.particle).collect();
        let lease = |index: usize| search.lease(index).ok_or("no query is pending");
        for &index in &asked {
            let (hash, _) = lease(index)?;
            if !evaluates.contains_key(hash) {
                let variant = search.variant(hash).ok_or("a variant is missing")?;
                evaluates.insert(hash.to_owned(), Evaluate::new(variant)?);
            }
        }
        let outcomes = each_on(threads, asked.len() as u64, |place| {
            let (hash, theta) = lease(asked[place as usize])?;
            Ok::<_, StudyError>(evaluates[hash].evaluate(theta))
        })?;
        for (index, outcome) in asked.into_iter().zip(outcomes) {
            let values = match outcome? {
                Outcome::Evaluated(observables) => search.values(index, &observables),
                Outcome::Rejected(_) | Outcome::Fault(_) => None,
            };
            search.tell(index, values.as_deref())?;
        }
    }
}

/// Returns whether the class of the truth is claimed; `None` without a claim.
///
/// # Arguments
/// - `truth`: the hidden effect; `None`: nothing is hidden.
pub fn is_right(record: &Discovery, truth: Option<&str>) -> Option<bool> {
    match record.verdict {
        Verdict::NothingDetectable | Verdict::Undecided => None,
        Verdict::NotInLibrary => Some(false),
        Verdict::Named | Verdict::Class => {
            let leading = record.effects.iter().find(|e| e.name != NONE);
            Some(truth.is_some() && leading.map(|e| e.class) == truth.and_then(|name| class(record, name)))
        }
    }
}

/// Returns the word for the correctness of a claim.
pub fn word(is_right: Option<bool>) -> &'static str {
    match is_right {
        Some(true) => "right",
        Some(false) => "WRONG",
        None => "open",
    }
}

/// Returns the name and probability of the most probable explanation.
pub fn leader(record: &Discovery) -> String {
    let effect = record.effects.first();
    let (name, probability) = effect.map_or(("", 0.0), |effect| (effect.name.as_str(), effect.probability));
    format!("{name} P {probability:.3}")
}

/// Returns the class of an effect.
pub fn class(record: &Discovery, name: &str) -> Option<u32> {
    let effect = record.effects.iter().find(|effect| effect.name == name);
    effect.map(|effect| effect.class)
}
