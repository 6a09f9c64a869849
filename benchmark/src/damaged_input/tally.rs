//! Counts over many inputs.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::time::Duration;

use super::corpus::Corpus;
use super::verdict::verdict;

/// Counts over the inputs of one reader.
#[derive(Debug, Default)]
pub struct ReaderTally {
    pub inputs: u64,
    pub accepted: u64,
    slowest: Duration,
    slowest_input: u64,
}

/// Counts over all inputs.
#[derive(Debug, Default)]
pub struct Tally {
    pub readers: BTreeMap<&'static str, ReaderTally>,
    /// The number of each input that broke a promise, with the promise.
    pub broken: Vec<(u64, String)>,
}

impl Tally {
    /// Reads the inputs of these numbers.
    pub fn new(corpus: &Corpus, seed: u64, numbers: Range<u64>) -> Tally {
        let mut tally = Tally::default();
        for number in numbers {
            let verdict = verdict(corpus, seed, number);
            let reader = tally.readers.entry(verdict.reader).or_default();
            reader.inputs += 1;
            reader.accepted += u64::from(verdict.is_accepted);
            if verdict.took > reader.slowest {
                // The input is read again, because the machine may have been busy.
                let took = verdict.took.min(self::verdict(corpus, seed, number).took);
                if took > reader.slowest {
                    (reader.slowest, reader.slowest_input) = (took, number);
                }
            }
            let broken = verdict
                .broken
                .map(|broken| format!("{}: {broken}", verdict.reader));
            tally.broken.extend(broken.map(|broken| (number, broken)));
        }
        tally
    }

    /// Returns the longest time that an input took.
    pub fn slowest(&self) -> Duration {
        let times = self.readers.values().map(|reader| reader.slowest);
        times.max().unwrap_or_default()
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<24} {:>9} {:>9} {:>11}   input",
            "reader", "inputs", "accepted", "slowest ms"
        )?;
        for (name, reader) in &self.readers {
            let slowest_ms = reader.slowest.as_secs_f64() * 1e3;
            writeln!(
                f,
                "{name:<24} {:>9} {:>9} {slowest_ms:>11.1}   {}",
                reader.inputs, reader.accepted, reader.slowest_input
            )?;
        }
        Ok(())
    }
}
