//! Searches with the three-dimensional model as a study runs them, with the answer, the reason and the time of each.

use std::time::Instant;

use record::Extension;

use crate::error::StudyError;
use crate::hidden_effect::study::design::Plan;
use crate::hidden_effect::study::draw::{draw_detectable, draw_from};
use crate::hidden_effect::study::rate::Rate;
use crate::hidden_effect::study::record::{is_right, record, word};
use crate::parallel::threads;
use crate::process::cpu_s;

/// The number of the first truth, which no other kind uses.
const FIRST: u64 = 3_000_000;
/// The largest time of a search `[s]`.
const MAX_S: f64 = 60.0;

/// Searches a number of experiments one after another, each on all threads.
///
/// # Arguments
/// - `hidden`: the hidden effect; `None` draws one from the catalogue.
pub fn run(plan: Plan, hidden: Option<&str>, count: u64, seed: u64) -> Result<(), StudyError> {
    let mut times = Vec::new();
    let mut right = Vec::new();
    let mut wrong = Vec::new();
    for number in 0..count {
        let case = match hidden {
            None => draw_detectable(plan, 1, seed, FIRST + number)?,
            Some(name) => {
                let effect = (name.to_owned(), Extension::Effect(name.to_owned()));
                draw_from(plan, &[effect], 1, seed, FIRST + number)?
            }
        };
        let begin = Instant::now();
        let cpu_before_s = cpu_s("self")?;
        let record = record(&case.plan.job(), &case.experiment(), 1, threads())?;
        let seconds = begin.elapsed().as_secs_f64();
        let is_right = is_right(&record, case.hidden.first().map(String::as_str));
        println!(
            "steady {number} {}: {seconds:.1} s, {:.1} CPU-s, {} evaluations, {}: {}",
            case.hidden[0],
            cpu_s("self")? - cpu_before_s,
            record.evaluations,
            word(is_right),
            record.text
        );
        times.push(seconds);
        right.push(is_right == Some(true));
        wrong.push(is_right == Some(false));
    }
    let longest = times.iter().copied().fold(0.0, f64::max);
    println!("named or classed right: {}", Rate::new(right.into_iter()));
    println!("wrong: {} (goal 0)", Rate::new(wrong.into_iter()));
    let short = Rate::new(times.iter().map(|time| *time <= MAX_S));
    println!(
        "within {MAX_S} s on {} threads: {short} (goal 1); longest {longest:.1} s",
        threads()
    );
    Ok(())
}
