//! Challenges that others stated: missing laws of systems that have nothing to do with wheels.
//!
//! `cargo bench -p benchmark --bench challenge -- bioreactor [SEEDS [FIRST]] [--transcript]`
//! `cargo bench -p benchmark --bench challenge -- corrections [SEEDS [FIRST]]`
//! `cargo bench -p benchmark --bench challenge -- odebench [SEEDS [FIRST]]`

mod bioreactor;
mod corrections;
mod odebench;

use std::process::ExitCode;

fn main() -> ExitCode {
    let all: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&String> = all.iter().filter(|a| !a.starts_with("--")).collect();
    let numbers: Result<Vec<u64>, _> = words.iter().skip(1).map(|word| word.parse()).collect();
    let Ok(numbers) = numbers else {
        eprintln!("error: SEEDS and FIRST are whole numbers");
        return ExitCode::FAILURE;
    };
    let seeds = |default: u64| numbers.first().copied().unwrap_or(default).max(1);
    let first = numbers.get(1).copied().unwrap_or(1);
    let result = match words.first().map(|word| word.as_str()) {
        Some("bioreactor") => bioreactor::run(seeds(50), first, all.iter().any(|a| a == "--transcript")),
        Some("corrections") => corrections::run(seeds(10), first),
        Some("odebench") => odebench::run(seeds(3), first),
        _ => Err("the first argument is bioreactor, corrections or odebench".into()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}
