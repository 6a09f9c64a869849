//! The words of columns, and those that mark held-out runs.

use std::collections::BTreeMap;

use super::card::{ColumnCard, WordCard};
use crate::field::RowUse;
use crate::table::{Row, spaced};

/// Maximum number of different words of a column in a proposal.
const MAX_WORDS: usize = 12;
/// Maximum length of a listed word, in bytes.
const MAX_WORD_BYTES: usize = 60;
/// The first word of a remark about a run that is held out, in lower case.
const HELD_OUT: [&str; 13] = [
    "holdout",
    "hold-out",
    "held",
    "control",
    "validation",
    "kontrolle",
    "kontrollversuch",
    "kontrollmessung",
    "kontrollfahrt",
    "kontrolllauf",
    "validierung",
    "validierungsversuch",
    "gegenprobe",
];
/// Words that alone, or beside the letter of an axis, say no more than that a column is a component of force or moment.
const OF_A_SENSOR: [&str; 11] = [
    "f",
    "force",
    "kraft",
    "m",
    "t",
    "torque",
    "moment",
    "drehmoment",
    "wrench",
    "sensor",
    "ft",
];
/// Components in one word.
const COMPONENTS: [&str; 9] = ["fx", "fy", "fz", "mx", "my", "mz", "tx", "ty", "tz"];

/// Returns the different words of a column in alphabetical order; none if they are too many or too long.
pub(super) fn words<'a>(rows: impl Iterator<Item = &'a Row>, column: usize) -> Vec<WordCard> {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for row in rows.filter(|row| !row.cell(column).is_blank()) {
        let word = spaced(&row.cell(column).shown());
        if word.len() > MAX_WORD_BYTES || (counts.len() == MAX_WORDS && !counts.contains_key(&word)) {
            return Vec::new();
        }
        *counts.entry(word).or_default() += 1;
    }
    // If one word marks held-out runs, the others mark fitted ones.
    let is_marked = counts.keys().any(|word| is_held_out(word));
    let means = |word: &str| match word.parse() {
        Ok(stated) => Some(stated),
        Err(_) if is_held_out(word) => Some(RowUse::Holdout),
        Err(_) => is_marked.then_some(RowUse::Fit),
    };
    let card = |(word, count): (&String, &usize)| WordCard {
        word: word.clone(),
        count: *count,
        means: means(word),
    };
    counts.iter().map(card).collect()
}

fn is_held_out(word: &str) -> bool {
    let word = word.to_lowercase();
    let first = word
        .split(|c: char| !c.is_alphanumeric() && c != '-')
        .next()
        .unwrap_or_default();
    HELD_OUT.contains(&first)
}

/// Returns whether the words of a column mark runs that are held out.
pub(super) fn marks_held_out(column: &ColumnCard) -> bool {
    column.words.iter().any(|card| is_held_out(&card.word))
}

/// Returns the question of a map about the words of a column for `use`; none if they are those of runs.csv.
pub(super) fn meanings(column: &ColumnCard) -> Vec<WordCard> {
    let is_of_runs_csv = |card: &WordCard| {
        [RowUse::Fit, RowUse::Holdout]
            .iter()
            .any(|row_use| row_use.name() == card.word)
    };
    if column.words.iter().all(is_of_runs_csv) {
        Vec::new()
    } else {
        column.words.clone()
    }
}

/// Returns whether the words of a column could mark runs: some occur in several rows, or some rows have none.
pub(super) fn could_mark(column: &ColumnCard, rows: usize) -> bool {
    let filled: usize = column.words.iter().map(|card| card.count).sum();
    let is_word = |card: &WordCard| !crate::number::is_number(&card.word);
    !column.words.is_empty()
        && column.words.iter().all(is_word)
        && (filled < rows || (column.words.len() > 1 && column.words.len() < filled))
}

/// Returns whether a title in separate lower-case words names a component by the letter of its axis, and nothing that tells its direction on the
/// rig: `fx`, `force z`, not `normal force z`.
pub(super) fn is_component(name: &str) -> bool {
    let is_axis = |word: &str| ["x", "y", "z"].contains(&word);
    let has_letter = name
        .split(' ')
        .any(|word| is_axis(word) || COMPONENTS.contains(&word));
    let is_told = |word: &str| !(is_axis(word) || COMPONENTS.contains(&word) || OF_A_SENSOR.contains(&word));
    let is_of_a_sensor = name.split(' ').any(|word| !is_axis(word));
    has_letter && is_of_a_sensor && !name.split(' ').any(is_told)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_component_is_told_from_a_direction_on_the_rig() {
        for name in [
            "fx",
            "f x",
            "force x",
            "wrench force z",
            "torque y",
            "ft sensor mz",
        ] {
            assert!(is_component(name), "{name}");
        }
        for name in [
            "x",
            "load z",
            "normal force z",
            "wheel torque y",
            "pull",
            "force",
            "axle fx",
        ] {
            assert!(!is_component(name), "{name}");
        }
    }
}
