//! A search as the farm runs it, with the record that a study stores.

use std::collections::BTreeMap;

use coordinator::embedded::Evaluate;
use record::{Discovery, NONE, Verdict};
use search::{RunningDiscovery, SearchModels};
use shared::file::FileSet;
use shared::outcome::Outcome;

use super::error::StudyError;
use super::parallel::each_on;

/// Searches what is missing.
///
/// # Arguments
/// - `max_effects`: most effects in a combination. `threads`: that share the evaluations of a round.
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
        let count = search.pending().len();
        let lease = |index: usize| search.lease(index).ok_or("no query is pending");
        for index in 0..count {
            let (hash, _) = lease(index)?;
            if !evaluates.contains_key(hash) {
                let variant = search.variant(hash).ok_or("a variant is missing")?;
                evaluates.insert(hash.to_owned(), Evaluate::new(variant)?);
            }
        }
        let outcomes = each_on(threads, count as u64, |index| {
            let (hash, theta) = lease(index as usize)?;
            Ok::<_, StudyError>(evaluates[hash].evaluate(theta))
        })?;
        for (index, outcome) in outcomes.into_iter().enumerate() {
            let values = match outcome? {
                Outcome::Evaluated(observables) => search.values(index, &observables),
                Outcome::Rejected(_) | Outcome::Fault(_) => None,
            };
            search.tell(index, values.as_deref())?;
        }
    }
}

/// Whether the truth's class is claimed; `None` without a claim.
///
/// # Arguments
/// - `truth`: the hidden effect; `None`: nothing is hidden.
pub fn is_right(record: &Discovery, truth: Option<&str>) -> Option<bool> {
    let class = |name: &str| record.effects.iter().find(|e| e.name == name).map(|e| e.class);
    match record.verdict {
        Verdict::NothingDetectable | Verdict::Undecided => None,
        Verdict::NotInLibrary => Some(false),
        Verdict::Named | Verdict::Class => {
            let leading = record.effects.iter().find(|e| e.name != NONE);
            Some(truth.is_some() && leading.map(|e| e.class) == truth.and_then(class))
        }
    }
}
