//! One trial: an experiment whose truth is known, drawn and searched.

use std::sync::Arc;
use std::time::Instant;

use job::{EffectOnNodes, Job};
use record::Extension;
use search::candidate::{CandidateEffect, library};
use shared::experiment::Experiment;
use statistics::rng::Stream;

use super::case::{SyntheticCase, blank};
use super::design::Plan;
use super::held_out::HeldOut;
use super::kind::HiddenKind;
use super::laws::LAWS;
use super::line::line;
use super::local_search::LocalSearch;
use super::noise_free::{MIN_SEPARATION, NoiseFree, shortfall};
use super::score::{TrialFacts, TrialScore};
use crate::error::StudyError;

/// The random stream of combinations of effects.
const STAGE: u64 = 1 << 44;
/// The number of the truths that are drawn by the name of their effect.
const NAMED: u64 = 9_000_000;
/// The largest number of combinations that are drawn until each effect is detectable.
const MAX_DRAWN: u64 = 1000;
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
    let place = |name: &String| task.library.iter().position(|c| c.name == *name);
    let truth = match kind {
        HiddenKind::One | HiddenKind::Spatial => Some(place(&case.hidden[0])),
        HiddenKind::Outside => Some(None),
        HiddenKind::None | HiddenKind::Two | HiddenKind::Three => None,
    };
    let (separation, over_base) = match truth {
        Some(effect) => {
            let noise_free = NoiseFree::new(case, &mut local)?;
            (noise_free.separation(effect), noise_free.over_base())
        }
        None => (f64::INFINITY, f64::INFINITY),
    };
    let facts = TrialFacts {
        separation,
        over_base,
        held_out: HeldOut::new(case, &mut local, &conclusion)?,
        seconds,
    };
    let law = LAWS.iter().find(|law| case.hidden == [law.name]);
    let law = law.map(|law| law.dependence);
    let mut score = TrialScore::new(kind, case, &task, &conclusion, law, facts);
    score.line = line(&score, case, &task, &conclusion, number);
    Ok(score)
}

/// Draws a truth and measures it.
pub fn draw(kind: HiddenKind, seed: u64, number: u64) -> Result<SyntheticCase, StudyError> {
    // The truths of different kinds have different numbers.
    let truth_number = 10_000 * kind as u64 + number;
    let turn = |count: usize| (number % count as u64) as usize;
    let draw =
        |plan: Plan, hidden: &[(String, Extension)]| SyntheticCase::draw(plan, hidden, seed, truth_number, 0);
    match kind {
        HiddenKind::None => draw(Plan::Full, &[]),
        HiddenKind::One => {
            let effects = expressible(Plan::Full)?;
            draw_effect(&effects[turn(effects.len())], seed, truth_number)
        }
        HiddenKind::Outside => draw(Plan::Full, &[LAWS[turn(LAWS.len())].hidden()]),
        HiddenKind::Two => draw_detectable(Plan::Full, 2, seed, truth_number),
        HiddenKind::Three => draw_detectable(Plan::Full, 3, seed, truth_number),
        HiddenKind::Spatial => draw_detectable(Plan::Spatial, 1, seed, truth_number),
    }
}

/// Draws a truth with one effect of the catalogue by its name. The truth is the same in a larger catalogue.
pub fn draw_named(name: &str, seed: u64) -> Result<SyntheticCase, StudyError> {
    let mut effects = expressible(Plan::Full)?.into_iter();
    let effect = effects.find(|(effect, _)| effect == name);
    let effect = effect.ok_or(format!("the experiment cannot show \"{name}\""))?;
    draw_effect(&effect, seed, NAMED)
}

fn draw_effect(
    effect: &(String, Extension),
    seed: u64,
    truth_number: u64,
) -> Result<SyntheticCase, StudyError> {
    SyntheticCase::draw(
        Plan::for_effect(&effect.0),
        std::slice::from_ref(effect),
        seed,
        truth_number,
        0,
    )
}

/// Draws effects of the catalogue at random until each of them is detectable in noise-free data.
pub fn draw_detectable(
    plan: Plan,
    count: usize,
    seed: u64,
    number: u64,
) -> Result<SyntheticCase, StudyError> {
    draw_from(plan, &expressible(plan)?, count, seed, number)
}

/// Draws some of these effects at random until each of them is detectable in noise-free data.
pub fn draw_from(
    plan: Plan,
    effects: &[(String, Extension)],
    count: usize,
    seed: u64,
    number: u64,
) -> Result<SyntheticCase, StudyError> {
    for attempt in 0..MAX_DRAWN {
        let mut stream = Stream::new(seed, STAGE, number, attempt);
        let mut rest = effects.to_vec();
        let mut hidden = Vec::new();
        for _ in 0..count {
            hidden.push(rest.swap_remove(stream.below(rest.len())));
        }
        // Some effects exclude each other, so that no truth can have both.
        let Ok(case) = SyntheticCase::draw(plan, &hidden, seed, number, attempt) else {
            continue;
        };
        if each_is_detectable(&case, &hidden)? {
            return Ok(case);
        }
    }
    Err(format!("each of {MAX_DRAWN} combinations of {count} effects has one that is not detectable").into())
}

/// Returns the effects of the catalogue that the experiment of a plan can show, each with its addition to the job.
fn expressible(plan: Plan) -> Result<Vec<(String, Extension)>, StudyError> {
    let job = Job::read("job.toml", &plan.job())?.into_search();
    let experiment = Experiment::parse("experiment.toml", &blank(&plan.rows()))?;
    let (candidates, _) = library(&job, &Arc::new(experiment));
    // Effects on a single wheel and effects on the nodes of the soil are excluded.
    let is_plain = |e: &CandidateEffect| !e.name.contains('.') && EffectOnNodes::find(&e.name).is_none();
    let candidates = candidates.into_iter().map(|(candidate, _)| candidate);
    let plain = candidates.filter(is_plain);
    Ok(plain.map(|e| (e.name, e.extension)).collect())
}

/// Returns whether the model falls short by the required nats if any one of the effects is left out.
fn each_is_detectable(case: &SyntheticCase, hidden: &[(String, Extension)]) -> Result<bool, StudyError> {
    for left_out in 0..hidden.len() {
        let others = hidden.iter().enumerate().filter(|(k, _)| *k != left_out);
        let others: Vec<&Extension> = others.map(|(_, (_, extension))| extension).collect();
        if shortfall(case, &others)? < MIN_SEPARATION {
            return Ok(false);
        }
    }
    Ok(true)
}
