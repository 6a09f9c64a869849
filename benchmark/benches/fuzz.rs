//! Every reader of files and messages, fed a million damaged inputs.
//!
//! `cargo bench -p benchmark --bench fuzz [-- N [SEED] | one SEED NUMBER]`: N inputs (default: a million, seed 1), or one input with the
//! answer of its reader. Exits with 1 if a reader panics; if a refusal does not name the file, has a control character or is too long; if
//! an input takes longer than a second; or if the program holds more than 256 MiB.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use benchmark::damaged_input::corpus::Corpus;
use benchmark::damaged_input::tally::Tally;
use benchmark::process::memory_kb;

/// The default number of inputs.
const INPUTS: u64 = 1_000_000;
/// The longest time for an input.
const MAX_TIME: Duration = Duration::from_secs(1);
/// The largest memory of the program `[MiB]`.
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
        // A panic is counted here; its place is printed when its input is read alone.
        std::panic::set_hook(Box::new(|_| {}));
    }
    let began = Instant::now();
    let tally = Tally::new(&corpus, seed, range);
    print!("{tally}");
    let peak_mib = peak_mib();
    let seconds = began.elapsed().as_secs_f64();
    println!("{seconds:.0} s, at most {peak_mib} MiB held");
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

/// Returns the largest memory of this program so far; 0 if the system does not provide it.
fn peak_mib() -> u64 {
    memory_kb("self", "VmHWM").unwrap_or(0) / 1024
}
