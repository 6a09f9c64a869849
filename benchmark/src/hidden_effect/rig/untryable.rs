//! Truths that the search cannot try, because the experiment does not state a property that they need.

use record::{Discovery, Extension, NONE, NOT_IN_LIBRARY, Verdict};

use super::super::study::case::SyntheticCase;
use super::super::study::design::Plan;
use super::super::study::noise_free::{MIN_SEPARATION, shortfall};
use super::super::study::rate::Rate;
use super::super::study::record::{class, leader, record};
use super::MAX_EFFECTS;
use crate::error::StudyError;
use crate::parallel::each;

/// The number of the first truth, which no other kind uses.
const FIRST: u64 = 2_000_000;
/// The largest number of truths that are drawn until the effect is detectable.
const MAX_DRAWN: u64 = 1000;
/// The effects, each with the lines of the experiment that it needs.
const TRUTHS: [(&str, &str); 2] = [
    ("bulldozing", "density_kg_m3 = 1400.0\n"),
    (
        "lug_thrust",
        "grouser_count = 12\ngrouser_height_m = 0.009\ngrouser_thickness_m = 0.002\n",
    ),
];

/// The answer of a search that could not try the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// No effect is claimed, and the truth is the most probable explanation.
    TruthLeads,
    /// No effect is claimed, and another explanation is the most probable.
    Open,
    /// Another effect or a law is claimed in place of the truth.
    StandIn,
}

/// Searches a number of experiments, and prints how often a stand-in is named.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let answers = each(count, |number| {
        let (answer, line) = one(seed, number)?;
        println!("{line}");
        Ok::<_, StudyError>(answer)
    })?;
    let rate = |wanted: Answer| Rate::new(answers.iter().map(|answer| *answer == wanted));
    println!("a stand-in is named: {} (goal 0)", rate(Answer::StandIn));
    println!("the truth leads, not tried: {}", rate(Answer::TruthLeads));
    println!("open otherwise: {}", rate(Answer::Open));
    Ok(())
}

/// Searches one experiment; returns the answer, and a line about it.
pub fn one(seed: u64, number: u64) -> Result<(Answer, String), StudyError> {
    let (name, unstated) = TRUTHS[(number % TRUTHS.len() as u64) as usize];
    let case = draw(name, seed, FIRST + number)?;
    let mut experiment = case.experiment();
    experiment.toml = experiment.toml.replace(unstated, "");
    let record = record(&case.plan.job(), &experiment, MAX_EFFECTS, 1)?;
    let (answer, leader) = (answer(&record, name), leader(&record));
    let line = format!(
        "untryable {number} {name}: {answer:?}, {:?}, {leader}",
        record.verdict
    );
    Ok((answer, line))
}

fn answer(record: &Discovery, truth: &str) -> Answer {
    let first = record.effects.first().map(|effect| effect.name.as_str());
    match record.verdict {
        Verdict::Named | Verdict::NotInLibrary => Answer::StandIn,
        // The truth may be a member of the class.
        Verdict::Class if class(record, truth) != leading_class(record) => Answer::StandIn,
        _ if first == Some(truth) => Answer::TruthLeads,
        _ => Answer::Open,
    }
}

fn leading_class(record: &Discovery) -> Option<u32> {
    let mut effects = record.effects.iter();
    let first = effects.find(|effect| effect.name != NONE && effect.name != NOT_IN_LIBRARY);
    first.map(|effect| effect.class)
}

/// Draws a truth with an effect that is detectable.
fn draw(name: &str, seed: u64, number: u64) -> Result<SyntheticCase, StudyError> {
    let hidden = [(name.to_owned(), Extension::Effect(name.to_owned()))];
    for attempt in 0..MAX_DRAWN {
        let case = SyntheticCase::draw(Plan::Full, &hidden, seed, number, attempt)?;
        if shortfall(&case, &[])? >= MIN_SEPARATION {
            return Ok(case);
        }
    }
    Err(format!("{MAX_DRAWN} strengths of {name} are not detectable").into())
}
