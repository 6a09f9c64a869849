//! What the posterior is worth to those who use it.
//!
//! `cargo bench -p benchmark --bench decision [-- [CAMPAIGNS [CONDITIONS [SEED]]]]` decides in 100 synthetic campaigns by the posterior and by
//! the most probable parameters, and predicts 200 unseen conditions of the example `hidden-effect`, whose truth is known. Exits with 1
//! unless the posterior's choices cost less on average, and the repaired model's 90 % intervals contain 88 to 92 % of new measurements.

use std::process::ExitCode;

use benchmark::error::StudyError;
use benchmark::posterior_use::{campaigns, unseen};

/// The share of new measurements that 90 % intervals are to contain.
const COVERAGE: std::ops::RangeInclusive<f64> = 0.88..=0.92;

fn main() -> ExitCode {
    let arguments = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let numbers: Result<Vec<u64>, _> = arguments.map(|argument| argument.parse()).collect();
    let Ok(numbers) = numbers else {
        eprintln!("error: CAMPAIGNS, CONDITIONS and SEED are whole numbers");
        return ExitCode::FAILURE;
    };
    let number = |i: usize, default: u64| numbers.get(i).copied().unwrap_or(default);
    match report(number(0, 100), number(1, 200), number(2, 1)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Prints what was found; returns whether it is as it is to be.
fn report(campaigns: u64, conditions: u64, seed: u64) -> Result<bool, StudyError> {
    let unseen = unseen::run(conditions, seed)?;
    unseen.iter().for_each(|model| print!("{model}"));
    let tally = campaigns::run(campaigns, seed)?;
    print!("{tally}");
    let covers = unseen
        .last()
        .is_some_and(|repaired| COVERAGE.contains(&repaired.coverage()));
    Ok(covers && tally.gain()[0] > 0.0)
}
