//! Truths of each kind, drawn at random or by the names of what is hidden.

use std::sync::Arc;

use job::{EffectOnNodes, Job};
use record::Extension;
use search::candidate::{CandidateEffect, library};
use shared::experiment::Experiment;
use statistics::rng::Stream;

use super::case::{SyntheticCase, blank};
use super::design::Plan;
use super::geometry::Misstatement;
use super::kind::HiddenKind;
use super::laws::{HiddenLaw, LAWS, LAWS_OF_TWO_VARIABLES};
use super::local_search::LocalSearch;
use super::noise_free::{MIN_SEPARATION, NoiseFree, shortfall};
use super::session::SessionError;
use crate::error::StudyError;

/// The random stream of combinations of effects.
const STAGE: u64 = 1 << 44;
/// The random stream of noise with heavy tails.
const HEAVY_NOISE: u64 = (1 << 44) + 1;
/// The number of the truths that are drawn by the names of what is hidden.
pub const NAMED: u64 = 9_000_000;
/// The largest number of combinations that are drawn until each effect is detectable.
const MAX_DRAWN: u64 = 1000;

/// An effect or a law with its addition to a job.
type Hidden = (String, Extension);

/// Draws a truth and measures it.
pub fn draw(kind: HiddenKind, seed: u64, number: u64) -> Result<SyntheticCase, StudyError> {
    // The truths of different kinds have different numbers.
    let truth_number = 10_000 * kind as u64 + number;
    let turn = |count: usize| (number % count as u64) as usize;
    let draw = |plan: Plan, hidden: &[Hidden]| SyntheticCase::draw(plan, hidden, seed, truth_number, 0);
    match kind {
        HiddenKind::None => draw(Plan::Full, &[]),
        HiddenKind::One => {
            let effects = expressible(Plan::Full)?;
            draw_effect(&effects[turn(effects.len())], seed, truth_number)
        }
        HiddenKind::Outside => draw(Plan::Full, &[LAWS[turn(LAWS.len())].hidden()]),
        HiddenKind::Two => draw_detectable(Plan::Full, 2, seed, truth_number),
        HiddenKind::Triple => draw_detectable(Plan::Full, 3, seed, truth_number),
        HiddenKind::Spatial => draw_detectable(Plan::Spatial, 1, seed, truth_number),
        HiddenKind::Outlib => {
            let (law, effects) = (LAWS[turn(LAWS.len())].hidden(), expressible(Plan::Full)?);
            draw_until_detectable(Plan::Full, seed, truth_number, |stream| {
                vec![law.clone(), effects[stream.below(effects.len())].clone()]
            })
        }
        HiddenKind::Twovar => {
            let law = &LAWS_OF_TWO_VARIABLES[turn(LAWS_OF_TWO_VARIABLES.len())];
            draw_beyond_library(law, seed, truth_number)
        }
        HiddenKind::Geometry => draw_misstated(
            Misstatement::ALL[turn(Misstatement::ALL.len())],
            seed,
            truth_number,
        ),
        HiddenKind::Sparse => draw_detectable(Plan::Sparse, 1, seed, truth_number),
        HiddenKind::Heavy => {
            let case = draw_detectable(Plan::Full, 1, seed, truth_number)?;
            Ok(case.measured_with_heavy_noise(Stream::new(seed, HEAVY_NOISE, truth_number, 0)))
        }
        HiddenKind::Session => {
            let case = match number % 2 {
                0 => draw(Plan::Full, &[])?,
                _ => draw_detectable(Plan::Full, 1, seed, truth_number)?,
            };
            let errors = SessionError::ALL;
            errors[number as usize / 2 % errors.len()].applied(case, seed, truth_number)
        }
    }
}

/// Draws a truth with one effect of the catalogue by its name. The truth is the same in a larger catalogue.
pub fn draw_named(name: &str, seed: u64) -> Result<SyntheticCase, StudyError> {
    let mut effects = expressible(Plan::Full)?.into_iter();
    let effect = effects.find(|(effect, _)| effect == name);
    let effect = effect.ok_or(format!("the experiment cannot show \"{name}\""))?;
    draw_effect(&effect, seed, NAMED)
}

/// Draws a truth of a kind by the names of what is hidden, each of which is detectable. The truth is the same in a larger catalogue.
///
/// # Arguments
/// - `names`: of laws outside the library, and of effects of the catalogue.
pub fn draw_combination(kind: HiddenKind, names: &[&str], seed: u64) -> Result<SyntheticCase, StudyError> {
    let plan = match kind {
        HiddenKind::Sparse => Plan::Sparse,
        _ => Plan::Full,
    };
    let effects = expressible(plan)?;
    let hidden = |name: &&str| -> Result<Hidden, StudyError> {
        let law = HiddenLaw::find(name).map(HiddenLaw::hidden);
        let effect = || effects.iter().find(|(effect, _)| effect == name).cloned();
        let hidden = law.or_else(effect);
        hidden.ok_or_else(|| format!("the experiment cannot show \"{name}\"").into())
    };
    let hidden: Vec<Hidden> = names.iter().map(hidden).collect::<Result<_, _>>()?;
    let case = draw_until_detectable(plan, seed, NAMED, |_| hidden.clone())?;
    Ok(match kind {
        HiddenKind::Heavy => case.measured_with_heavy_noise(Stream::new(seed, HEAVY_NOISE, NAMED, 0)),
        _ => case,
    })
}

/// Draws an experiment in sessions, with one effect of the catalogue by its name or without one.
pub fn draw_in_sessions(
    error: SessionError,
    effect: Option<&str>,
    seed: u64,
) -> Result<SyntheticCase, StudyError> {
    let case = match effect {
        None => SyntheticCase::draw(Plan::Full, &[], seed, NAMED, 0)?,
        Some(effect) => draw_combination(HiddenKind::Session, &[effect], seed)?,
    };
    error.applied(case, seed, NAMED)
}

/// Draws an experiment without a missing effect that states a dimension wrongly.
pub fn draw_misstated(wrong: Misstatement, seed: u64, number: u64) -> Result<SyntheticCase, StudyError> {
    let mut case = SyntheticCase::draw(wrong.plan(), &[], seed, number, 0)?;
    case.hidden = vec![wrong.effect.to_owned()];
    case.stated = wrong.stated();
    Ok(case)
}

fn draw_effect(effect: &Hidden, seed: u64, truth_number: u64) -> Result<SyntheticCase, StudyError> {
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
    effects: &[Hidden],
    count: usize,
    seed: u64,
    number: u64,
) -> Result<SyntheticCase, StudyError> {
    draw_until_detectable(plan, seed, number, |stream| {
        let mut rest = effects.to_vec();
        let drawn = (0..count).map(|_| rest.swap_remove(stream.below(rest.len())));
        drawn.collect()
    })
}

/// Draws truths until each hidden effect or law is detectable in noise-free data.
///
/// # Arguments
/// - `pick`: picks what is hidden, with a random stream for each attempt.
fn draw_until_detectable(
    plan: Plan,
    seed: u64,
    number: u64,
    pick: impl Fn(&mut Stream) -> Vec<Hidden>,
) -> Result<SyntheticCase, StudyError> {
    draw_until(plan, seed, number, pick, each_is_detectable)
}

/// Draws truths with a law until noise-free data separate it from every effect of the library.
pub fn draw_beyond_library(law: &HiddenLaw, seed: u64, number: u64) -> Result<SyntheticCase, StudyError> {
    let is_beyond = |case: &SyntheticCase, _: &[Hidden]| {
        let mut local = LocalSearch::new(&case.plan.job(), &case.experiment(), 1)?;
        Ok(NoiseFree::new(case, &mut local)?.separation(None) >= MIN_SEPARATION)
    };
    draw_until(Plan::Full, seed, number, |_| vec![law.hidden()], is_beyond)
}

fn draw_until(
    plan: Plan,
    seed: u64,
    number: u64,
    pick: impl Fn(&mut Stream) -> Vec<Hidden>,
    is_accepted: impl Fn(&SyntheticCase, &[Hidden]) -> Result<bool, StudyError>,
) -> Result<SyntheticCase, StudyError> {
    for attempt in 0..MAX_DRAWN {
        let hidden = pick(&mut Stream::new(seed, STAGE, number, attempt));
        // Some effects exclude each other, so that no truth can have both.
        let Ok(case) = SyntheticCase::draw(plan, &hidden, seed, number, attempt) else {
            continue;
        };
        if is_accepted(&case, &hidden)? {
            return Ok(case);
        }
    }
    Err(format!("each of {MAX_DRAWN} draws has an effect or a law that is not detectable").into())
}

/// Returns the effects of the catalogue that the experiment of a plan can show, each with its addition to the job.
fn expressible(plan: Plan) -> Result<Vec<Hidden>, StudyError> {
    let job = Job::read("job.toml", &plan.job())?.into_search();
    let experiment = Experiment::parse("experiment.toml", &blank(&plan.rows()))?;
    let (candidates, _) = library(&job, &Arc::new(experiment));
    // Effects on a single wheel and effects on the nodes of the soil are excluded.
    let is_plain = |e: &CandidateEffect| !e.name.contains('.') && EffectOnNodes::find(&e.name).is_none();
    let candidates = candidates.into_iter().map(|(candidate, _)| candidate);
    let plain = candidates.filter(is_plain);
    Ok(plain.map(|e| (e.name, e.extension)).collect())
}

/// Returns whether the model falls short by the required nats if any one of the effects and laws is left out.
fn each_is_detectable(case: &SyntheticCase, hidden: &[Hidden]) -> Result<bool, StudyError> {
    for left_out in 0..hidden.len() {
        let others = hidden.iter().enumerate().filter(|(k, _)| *k != left_out);
        let others: Vec<&Extension> = others.map(|(_, (_, extension))| extension).collect();
        if shortfall(case, &others)? < MIN_SEPARATION {
            return Ok(false);
        }
    }
    Ok(true)
}
