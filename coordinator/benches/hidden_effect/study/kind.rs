//! What is hidden: nothing, effects of the library, a law outside it.

use std::time::Instant;

use coordinator::missing_effect::candidate::library;
use record::Extension;
use statistics::rng::Stream;

use super::case::{Case, blank};
use super::clear::{CLEAR, Clear, shortfall};
use super::design::Plan;
use super::fate::{Fate, Known};
use super::held_out::HeldOut;
use super::laws::LAWS;
use super::pipeline::Asking;

/// Streams that choose which effects act together.
const STAGE: u64 = 1 << 44;
/// Sets of effects that are drawn until each is worth enough.
const MOST_DRAWN: u64 = 1000;
/// Most effects that are looked for together.
const MAX_EFFECTS: usize = 3;

/// What is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    One,
    None,
    Outside,
    Two,
    Three,
    /// One effect worth 10 nats, of the three-dimensional model: what cannot be seen costs as much as what can.
    Spatial,
}

impl Kind {
    pub(crate) const ALL: [Kind; 6] = [
        Kind::One,
        Kind::None,
        Kind::Outside,
        Kind::Two,
        Kind::Three,
        Kind::Spatial,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Kind::One => "one",
            Kind::None => "none",
            Kind::Outside => "outside",
            Kind::Two => "two",
            Kind::Three => "three",
            Kind::Spatial => "scm",
        }
    }

    /// Searches an experiment blind, and compares.
    pub(crate) fn search(self, case: &Case, number: u64) -> Result<Fate, String> {
        let most = if self == Kind::Spatial { 1 } else { MAX_EFFECTS };
        let mut asking = Asking::new(&case.plan.job(), &case.experiment(), most)?;
        let begin = Instant::now();
        let answer = asking.inquire()?;
        let seconds = begin.elapsed().as_secs_f64();
        let task = asking.models.task();
        let own = |name: &String| task.library.iter().position(|c| c.name == *name);
        let (separation, over_base) = match self {
            Kind::One | Kind::Spatial => {
                let clear = Clear::new(case, &mut asking)?;
                (clear.separation(own(&case.hidden[0])), clear.over_base())
            }
            Kind::Outside => {
                let clear = Clear::new(case, &mut asking)?;
                (clear.separation(None), clear.over_base())
            }
            Kind::None | Kind::Two | Kind::Three => (f64::INFINITY, f64::INFINITY),
        };
        let known = Known {
            number,
            separation,
            over_base,
            held_out: HeldOut::new(case, &mut asking, &answer)?,
            seconds,
        };
        let law = LAWS.iter().find(|law| case.hidden == [law.name]);
        Ok(Fate::new(
            self,
            case,
            &task,
            &answer,
            law.map(|law| law.pair),
            known,
        ))
    }

    /// Draws a truth, and measures it.
    pub(crate) fn draw(self, seed: u64, number: u64) -> Result<Case, String> {
        // Each kind has truths of its own.
        let number_of_all = 10_000 * self as u64 + number;
        let turn = |count: usize| (number % count as u64) as usize;
        let draw =
            |plan: Plan, hidden: &[(String, Extension)]| Case::draw(plan, hidden, seed, number_of_all, 0);
        match self {
            Kind::None => draw(Plan::Full, &[]),
            Kind::One => {
                let known = expressible(Plan::Full);
                let own = &known[turn(known.len())];
                draw(Plan::of(&own.0), std::slice::from_ref(own))
            }
            Kind::Outside => draw(Plan::Full, &[LAWS[turn(LAWS.len())].hidden()]),
            Kind::Two => draw_clear(Plan::Full, 2, seed, number_of_all),
            Kind::Three => draw_clear(Plan::Full, 3, seed, number_of_all),
            Kind::Spatial => draw_clear(Plan::Spatial, 1, seed, number_of_all),
        }
    }
}

/// Draws so many effects of the catalogue at random until, without noise, the model without any one of them falls short by enough.
pub(crate) fn draw_clear(plan: Plan, count: usize, seed: u64, number: u64) -> Result<Case, String> {
    let known = expressible(plan);
    for attempt in 0..MOST_DRAWN {
        let mut stream = Stream::new(seed, STAGE, number, attempt);
        let mut rest = known.clone();
        let mut hidden = Vec::new();
        for _ in 0..count {
            hidden.push(rest.swap_remove(stream.below(rest.len())));
        }
        // Some effects do not go together.
        let Ok(case) = Case::draw(plan, &hidden, seed, number, attempt) else {
            continue;
        };
        if each_counts(&case, &hidden)? {
            return Ok(case);
        }
    }
    Err(format!(
        "{MOST_DRAWN} sets of {count} effects, each with one that counts for nothing"
    ))
}

/// The effects of the catalogue that a plan can have, each with what a job adds for it.
fn expressible(plan: Plan) -> Vec<(String, Extension)> {
    let (explanations, _) = library(&plan.job(), &blank(&plan.rows()));
    // An effect on one wheel alone is none of the catalogue's own.
    let own = explanations.into_iter().filter(|e| !e.name.contains('.'));
    own.map(|e| (e.name, e.extension)).collect()
}

/// Whether the model without each of the effects falls short by enough.
fn each_counts(case: &Case, hidden: &[(String, Extension)]) -> Result<bool, String> {
    for left_out in 0..hidden.len() {
        let others = hidden.iter().enumerate().filter(|(k, _)| *k != left_out);
        let others: Vec<&Extension> = others.map(|(_, (_, extension))| extension).collect();
        if shortfall(case, &others)? < CLEAR {
            return Ok(false);
        }
    }
    Ok(true)
}
