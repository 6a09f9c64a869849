//! How well a recording is followed.
//!
//! `cargo bench -p benchmark --bench stream [-- [RECORDINGS [SEED]]]` follows 50 recordings of 200 s at 10 Hz with two changes of the soil,
//! as many without a change, and as many of a soil that walks. Exits with 1 unless 90 % intervals hold the true parameters 85 to 95 % of the
//! time in each, five seconds after a change left out; nine of ten changes are found, at most one false alarm is raised in 1,000 s, and 99
//! of 100 samples take at most 50 ms.

use std::process::ExitCode;

use benchmark::error::StudyError;
use benchmark::posterior_use::recordings::{Tally, run};

/// The share of the time at which 90 % intervals are to hold the truth.
const COVERAGE: std::ops::RangeInclusive<f64> = 0.85..=0.95;
/// The size of the walk in the last set, in standard deviations of the prior in a second.
const WALK: f64 = 0.02;
/// The time that a sample may take `[s]`.
const SAMPLE_S: f64 = 0.05;
/// The least mean interval of false alarms `[s]`.
const ALARM_S: f64 = 1000.0;
/// The length of a recording `[s]`.
const LENGTH_S: f64 = 200.0;

fn main() -> ExitCode {
    let arguments = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let numbers: Result<Vec<u64>, _> = arguments.map(|argument| argument.parse()).collect();
    let Ok(numbers) = numbers else {
        eprintln!("error: RECORDINGS and SEED are whole numbers");
        return ExitCode::FAILURE;
    };
    let number = |i: usize, default: u64| numbers.get(i).copied().unwrap_or(default);
    match report(number(0, 50), number(1, 1)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Prints what was found; returns whether it is as it is to be.
fn report(count: u64, seed: u64) -> Result<bool, StudyError> {
    let mut is_good = true;
    for (changes, walk) in [(true, 0.0), (false, 0.0), (false, WALK)] {
        let tally = run(count, seed, changes, walk)?;
        print!("{tally}");
        is_good &= good(&tally, count);
    }
    Ok(is_good)
}

fn good(tally: &Tally, count: u64) -> bool {
    let (found, missed) = tally.delays();
    let times = tally.sample_times_s();
    let slow = times.iter().filter(|time| **time > SAMPLE_S).count();
    COVERAGE.contains(&tally.mean_coverage())
        && missed * 9 <= found.len()
        && tally.false_alarms() as f64 * ALARM_S <= count as f64 * LENGTH_S
        && slow * 100 <= times.len()
}
