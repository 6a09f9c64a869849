//! Searches with the three-dimensional model as a study runs them: the answer of each, its reason, and its time.

use std::time::Instant;

use record::Extension;

use crate::hidden_effect::study::cpu::cpu_s;
use crate::hidden_effect::study::design::Plan;
use crate::hidden_effect::study::error::StudyError;
use crate::hidden_effect::study::parallel::threads;
use crate::hidden_effect::study::rate::Rate;
use crate::hidden_effect::study::record::{is_right, record};
use crate::hidden_effect::study::trial::{draw_detectable, draw_of};

/// The truths are others than those of the other kinds.
const FIRST: u64 = 3_000_000;
/// Most seconds of a search.
const MAX_S: f64 = 60.0;

/// Searches so many experiments one after the other, each on all threads.
///
/// # Arguments
/// - `hidden`: the effect that is hidden; `None`: any of the catalogue.
pub fn run(plan: Plan, hidden: Option<&str>, count: u64, seed: u64) -> Result<(), StudyError> {
    let mut times = Vec::new();
    let mut right = Vec::new();
    let mut wrong = Vec::new();
    for number in 0..count {
        let case = match hidden {
            None => draw_detectable(plan, 1, seed, FIRST + number)?,
            Some(name) => {
                let own = (name.to_owned(), Extension::Effect(name.to_owned()));
                draw_of(plan, &[own], 1, seed, FIRST + number)?
            }
        };
        let begin = Instant::now();
        let cpu = cpu_s();
        let record = record(&case.plan.job(), &case.experiment(), 1, threads())?;
        let seconds = begin.elapsed().as_secs_f64();
        let is_right = is_right(&record, case.hidden.first().map(String::as_str));
        println!(
            "steady {number} {}: {seconds:.1} s, {:.1} CPU-s, {} evaluations, {}: {}",
            case.hidden[0],
            cpu_s() - cpu,
            record.evaluations,
            match is_right {
                Some(true) => "right",
                Some(false) => "WRONG",
                None => "open",
            },
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
