//! The farm under real chaos: kills, halts, cut connections, full disks and backups put back.
//!
//! `cargo bench -p benchmark --bench chaos [-- EVENTS [SEED]]`: a thousand events where nothing is said. Three studies are in
//! progress all the time, each compared bit for bit with what its job gives undisturbed. Exits with 1 where a promise is broken, and
//! says after which event; docs/promises.md has the promises.

use std::process::ExitCode;

use farm_tests::chaos::soak;

/// Events where nothing is said.
const EVENTS: u64 = 1_000;
/// Seed where nothing is said.
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
    let (tally, broken) = soak(events, seed, |event| println!("{event}"));
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
