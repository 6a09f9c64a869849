//! A simulation of the farm under faults, for a million random schedules.
//!
//! `cargo bench -p farm --bench simulation [-- schedules N [FIRST] | planted | seed S [BUG]]`: runs a million schedules by default; every
//! planted bug until it is found; or one schedule with a log of its events. Exits with 1 where a promise is broken, or where a planted bug
//! is not found within a minute. docs/promises.md describes schedules.

mod world;

use std::ops::Range;
use std::process::ExitCode;
use std::time::Duration;

use world::case::Case;
use world::plant::Plant;
use world::schedule::{self, Journal};
use world::search::{Search, search};

/// The number of schedules without an argument.
const SCHEDULES: u64 = 1_000_000;
/// The time within which a planted bug must be found.
const MAX_TIME: Duration = Duration::from_secs(60);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words[..] {
        [] => schedules(1..SCHEDULES + 1),
        ["planted"] => planted(),
        ["schedules", number] => seeds(number, "1").and_then(schedules),
        ["schedules", number, first] => seeds(number, first).and_then(schedules),
        ["seed", seed] => seed
            .parse()
            .map_err(|_| USAGE.to_owned())
            .and_then(|seed| one(seed, None)),
        ["seed", seed, bug] => {
            let plant = Plant::ALL
                .iter()
                .copied()
                .find(|plant| format!("{plant:?}") == bug);
            let seed = seed.parse().ok().filter(|_| plant.is_some());
            seed.ok_or_else(|| USAGE.to_owned())
                .and_then(|seed| one(seed, plant))
        }
        _ => Err(USAGE.into()),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

const USAGE: &str = "expected schedules N [FIRST], planted, or seed S [BUG]";

/// Returns a range of `number` seeds that begins with `first`.
fn seeds(number: &str, first: &str) -> Result<Range<u64>, String> {
    let numbers = number.parse::<u64>().ok().zip(first.parse::<u64>().ok());
    let end = numbers.and_then(|(number, first)| Some((first, first.checked_add(number)?)));
    end.map(|(first, end)| first..end).ok_or_else(|| USAGE.to_owned())
}

/// Runs the schedules of some seeds on all cores. Returns whether every promise is kept.
fn schedules(seeds: Range<u64>) -> Result<bool, String> {
    let cases = Case::all()?;
    let Search { tally, broken, time } = search(&cases, None, seeds, None);
    let seconds = time.as_secs_f64();
    print!("{tally}");
    println!(
        "{seconds:.0} s, {:.1} million an hour",
        3.6e-3 * tally.schedules as f64 / seconds
    );
    match &broken {
        None => println!("every promise is kept"),
        Some((seed, broken)) => println!("BROKEN PROMISE {broken}\nagain: -- seed {seed}"),
    }
    Ok(broken.is_none())
}

/// Searches for every planted bug. Returns whether each is found in time.
fn planted() -> Result<bool, String> {
    let cases = Case::all()?;
    let mut all = true;
    println!("{:<24} {:>10} {:>8}  found by", "planted bug", "schedules", "s");
    for &plant in Plant::ALL {
        let Search { tally, broken, time } = search(&cases, Some(plant), 1..u64::MAX, Some(MAX_TIME));
        let found = broken.map_or("NOT FOUND".into(), |(seed, broken)| {
            format!("{broken} (seed {seed})")
        });
        all &= found != "NOT FOUND";
        println!(
            "{:<24} {:>10} {:>8.2}  {found}",
            format!("{plant:?}"),
            tally.schedules + 1,
            time.as_secs_f64()
        );
    }
    Ok(all)
}

/// Runs one schedule and prints its events. Returns whether every promise is kept.
fn one(seed: u64, plant: Option<Plant>) -> Result<bool, String> {
    let cases = Case::all()?;
    match schedule::run(&cases, seed, plant, Journal(true)) {
        Ok(tally) => {
            print!("{tally}");
            Ok(true)
        }
        Err(_) => Ok(false),
    }
}
