//! The promises of a reader: no panic, and a refusal in one short line that names the file.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use super::corpus::Corpus;
use super::input::Input;

/// The largest length of a refusal `[bytes]`.
const MAX_LENGTH: usize = 2000;

/// The verdict on the reading of an input.
#[derive(Debug)]
pub struct Verdict {
    pub reader: &'static str,
    pub is_accepted: bool,
    pub took: Duration,
    /// The broken promise.
    pub broken: Option<String>,
}

/// Reads the input of a number, and judges its reader.
pub fn verdict(corpus: &Corpus, seed: u64, number: u64) -> Verdict {
    let input = Input::new(corpus, seed, number);
    let began = Instant::now();
    let read = catch_unwind(AssertUnwindSafe(|| input.read()));
    let took = began.elapsed();
    let broken = match &read {
        Err(_) => Some("a panic".to_owned()),
        Ok(Ok(())) => None,
        Ok(Err(message)) => {
            let message = message.to_string();
            let names_one = input
                .files()
                .iter()
                .any(|file| message.starts_with(file.as_str()));
            let wrong = if message.chars().any(char::is_control) {
                Some("a control character")
            } else if message.len() >= MAX_LENGTH {
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
