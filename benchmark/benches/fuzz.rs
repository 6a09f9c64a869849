//! Every reader of files and messages, fed damaged inputs by the million.
//!
//! `cargo bench -p benchmark --bench fuzz [-- N [SEED] | one SEED NUMBER]`: a million inputs from seed 1 where nothing is said, or one
//! input with what its reader says. Exits with 1 where a reader panics, refuses without the name of the file, with a control character or
//! at length, takes longer than a second, or where the program holds more than 256 MiB.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use benchmark::damaged_input::corpus::Corpus;
use benchmark::damaged_input::tally::Tally;

/// Inputs where nothing is said.
const INPUTS: u64 = 1_000_000;
/// Longest time for an input.
const MAX_TIME: Duration = Duration::from_secs(1);
/// Most memory that the program may have held `[MiB]`.
const MAX_MIB: u64 = 256;

fn main() -> ExitCode {
    let numbers = std::env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with("--"));
    let numbers: Result<Vec<u64>, _> = numbers
        .filter(|word| word != "one")
        .map(|word| word.parse())
        .collect();
    let corpus = match Corpus::read() {
        Ok(corpus) => corpus,
        Err(error) => return failed(&error.to_string()),
    };
    let is_one = std::env::args().any(|argument| argument == "one");
    let (seed, range) = match (numbers.as_deref(), is_one) {
        (Ok(&[seed, number]), true) => (seed, number..number + 1),
        (Ok([]), false) => (1, 0..INPUTS),
        (Ok(&[inputs]), false) => (1, 0..inputs),
        (Ok(&[inputs, seed]), false) => (seed, 0..inputs),
        _ => return failed("expected N [SEED], or one SEED NUMBER"),
    };
    if !is_one {
        // A panic is counted; its place is printed where its input is asked for alone.
        std::panic::set_hook(Box::new(|_| {}));
    }
    let began = Instant::now();
    let tally = Tally::of(&corpus, seed, range);
    print!("{tally}");
    let peak_mib = peak_mib();
    println!(
        "{:.0} s, at most {peak_mib} MiB held",
        began.elapsed().as_secs_f64()
    );
    for (number, broken) in tally.broken.iter().take(20) {
        println!("one {seed} {number}: {broken}");
    }
    if !tally.broken.is_empty() {
        return failed(&format!("{} inputs broke a promise", tally.broken.len()));
    }
    if tally.slowest() > MAX_TIME || peak_mib > MAX_MIB {
        return failed("an input took more than 1 s, or the program more than 256 MiB");
    }
    ExitCode::SUCCESS
}

fn failed(message: &str) -> ExitCode {
    eprintln!("error: {message}");
    ExitCode::FAILURE
}

/// Most memory that this program has held; 0 where the system does not say.
fn peak_mib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = peak.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok());
    kib.unwrap_or(0) / 1024
}
