//! Truths that the search cannot try, because the experiment does not state what they need.

use record::{Discovery, NONE, NOT_IN_LIBRARY, Verdict};

use super::super::study::case::SyntheticCase;
use super::super::study::design::Plan;
use super::super::study::error::StudyError;
use super::super::study::noise_free::{MIN_SEPARATION, shortfall};
use super::super::study::parallel::each;
use super::super::study::rate::Rate;
use super::super::study::record::record;
use super::MAX_EFFECTS;
use record::Extension;

/// The truths are others than those of the other kinds.
const FIRST: u64 = 2_000_000;
/// Truths that are drawn until the effect is detectable.
const MAX_DRAWN: u64 = 1000;
/// Effects with the lines of the experiment that they need.
const TRUTHS: [(&str, &str); 2] = [
    ("bulldozing", "density_kg_m3 = 1400.0\n"),
    (
        "lug_thrust",
        "grouser_count = 12\ngrouser_height_m = 0.009\ngrouser_thickness_m = 0.002\n",
    ),
];

/// What a search says where the truth could not be tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Said {
    /// Undecided or nothing detectable, and the truth is the most probable explanation.
    TruthLeads,
    Open,
    /// An effect that stands in for the truth is named, or a law.
    StandIn,
}

/// Searches so many experiments, and prints how often a stand-in is named.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let said = each(count, |number| {
        let (said, line) = one(seed, number)?;
        println!("{line}");
        Ok::<_, StudyError>(said)
    })?;
    let said: Vec<Said> = said.into_iter().collect::<Result<_, StudyError>>()?;
    let rate = |wanted: Said| Rate::new(said.iter().map(|own| *own == wanted));
    println!("a stand-in is named: {} (goal 0)", rate(Said::StandIn));
    println!("the truth leads, not tried: {}", rate(Said::TruthLeads));
    println!("open otherwise: {}", rate(Said::Open));
    Ok(())
}

/// One experiment: what is said, and a line about it.
pub fn one(seed: u64, number: u64) -> Result<(Said, String), StudyError> {
    let (name, unstated) = TRUTHS[(number % TRUTHS.len() as u64) as usize];
    let case = draw(name, seed, FIRST + number)?;
    let mut experiment = case.experiment();
    experiment.toml = experiment.toml.replace(unstated, "");
    let record = record(&case.plan.job(), &experiment, MAX_EFFECTS, 1)?;
    let first = record.effects.first();
    let said = said(&record, name);
    let shown = format!(
        "untryable {number} {name}: {said:?}, {:?}, {} P {:.3}",
        record.verdict,
        first.map_or("", |effect| effect.name.as_str()),
        first.map_or(0.0, |effect| effect.probability),
    );
    Ok((said, shown))
}

fn said(record: &Discovery, truth: &str) -> Said {
    let first = record.effects.first().map(|effect| effect.name.as_str());
    match record.verdict {
        Verdict::Named | Verdict::NotInLibrary => Said::StandIn,
        // The truth may be a member of the class.
        Verdict::Class if class_of(record, truth) != leading_class(record) => Said::StandIn,
        _ if first == Some(truth) => Said::TruthLeads,
        _ => Said::Open,
    }
}

fn class_of(record: &Discovery, name: &str) -> Option<u32> {
    let own = record.effects.iter().find(|effect| effect.name == name);
    own.map(|effect| effect.class)
}

fn leading_class(record: &Discovery) -> Option<u32> {
    let mut effects = record.effects.iter();
    let first = effects.find(|effect| effect.name != NONE && effect.name != NOT_IN_LIBRARY);
    first.map(|effect| effect.class)
}

/// A truth with one effect that can be detected.
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
