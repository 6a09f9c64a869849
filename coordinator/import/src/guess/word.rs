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
