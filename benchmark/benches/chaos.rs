//! The farm under real chaos: kills, halts, cut connections, full disks and restored backups.
//!
//! `cargo bench -p benchmark --bench chaos [-- EVENTS [SEED]]`; the default is a thousand events. Three studies are always in progress, and
//! each is compared bit for bit with the undisturbed outcome of its job. Exits with 1 and names the event after which a promise is broken;
//! docs/promises.md has the promises.

use std::process::ExitCode;

use farm_tests::chaos::run;

/// The default number of events.
const EVENTS: u64 = 1_000;
/// The default seed.
const SEED: u64 = 1;

fn main() -> ExitCode {
    let words = std::env::args().skip(1).filter(|word| !word.starts_with("--"));
    let numbers: Result<Vec<u64>, _> = words.map(|word| word.parse()).collect();
    let (events, seed) = match numbers.as_deref() {
        Ok([]) => (EVENTS, SEED),
        Ok([events]) => (*events, SEED),
        Ok([events, seed]) => (*events, *seed),
        _ => {
            eprintln!("error: expected [EVENTS [SEED]], two numbers");
            return ExitCode::FAILURE;
        }
    };
    let (tally, broken) = run(events, seed, |event| println!("{event}"));
    print!("{tally}");
    match broken {
        None => {
            println!("every promise is kept");
            ExitCode::SUCCESS
        }
        Some(broken) => {
            println!("BROKEN PROMISE, {broken}");
            ExitCode::FAILURE
        }
    }
}
