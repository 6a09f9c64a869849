//! One trial: an experiment whose truth is known, searched.

use std::time::Instant;

use super::case::SyntheticCase;
use super::held_out::HeldOut;
use super::kind::HiddenKind;
use super::line::line;
use super::local_search::LocalSearch;
use super::noise_free::NoiseFree;
use super::score::{TrialFacts, TrialScore};
use super::truth::Truth;
use crate::error::StudyError;

/// The largest number of effects in a combination of the search.
const MAX_EFFECTS: usize = 3;

/// Searches an experiment without its truth, and scores the result.
pub fn search(kind: HiddenKind, case: &SyntheticCase, number: u64) -> Result<TrialScore, StudyError> {
    let max_effects = if kind == HiddenKind::Spatial {
        1
    } else {
        MAX_EFFECTS
    };
    let mut local = LocalSearch::new(&case.plan.job(), &case.experiment(), max_effects)?;
    let begin = Instant::now();
    let conclusion = local.run()?;
    let seconds = begin.elapsed().as_secs_f64();
    let task = local.models.task();
    let truth = Truth::new(&case.hidden, &task)?;
    // The likelihood of sessions has inferred sds, for which noise-free data have no highest likelihood.
    let single = truth.single().filter(|_| kind != HiddenKind::Session);
    let (separation, over_base) = match single {
        Some(effect) => {
            let noise_free = NoiseFree::new(case, &mut local)?;
            (noise_free.separation(effect), noise_free.over_base())
        }
        None => (f64::INFINITY, f64::INFINITY),
    };
    let facts = TrialFacts {
        hidden: case.hidden.join("+"),
        separation,
        over_base,
        held_out: HeldOut::new(case, &mut local, &conclusion)?,
        seconds,
    };
    let mut score = TrialScore::new(kind, &truth, &task, &conclusion, facts);
    score.line = line(&score, case, &task, &conclusion, number);
    Ok(score)
}
