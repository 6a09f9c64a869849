//! What a reader must keep: no panic, and a refusal in one short line that names the file.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use super::corpus::Corpus;
use super::input::Input;

/// Longest refusal `[bytes]`.
const LONGEST: usize = 2000;

/// What a reader made of an input.
#[derive(Debug)]
pub struct Verdict {
    pub reader: &'static str,
    pub is_accepted: bool,
    pub took: Duration,
    /// What it did not keep.
    pub broken: Option<String>,
}

/// Reads the input of a number.
pub fn verdict(corpus: &Corpus, seed: u64, number: u64) -> Verdict {
    let input = Input::new(corpus, seed, number);
    let began = Instant::now();
    let read = catch_unwind(AssertUnwindSafe(|| input.read()));
    let took = began.elapsed();
    let broken = match &read {
        Err(_) => Some("a panic".to_owned()),
        Ok(Ok(())) => None,
        Ok(Err(message)) => {
            let names_one = input
                .files()
                .iter()
                .any(|file| message.starts_with(file.as_str()));
            let wrong = if message.chars().any(char::is_control) {
                Some("a control character")
            } else if message.len() >= LONGEST {
                Some("a long refusal")
            } else if !names_one {
                Some("a refusal that names no file")
            } else {
                None
            };
            wrong.map(|wrong| format!("{wrong}: {message:?}"))
        }
    };
    Verdict {
        reader: input.reader(),
        is_accepted: matches!(read, Ok(Ok(()))),
        took,
        broken,
    }
}
