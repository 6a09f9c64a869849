//! Helpers for columns of text: widths, cells that may be empty, sentences broken into lines.

use std::fmt::Write;

/// Maximum number of characters in a line.
const WIDTH: usize = 80;
/// Width of the label before a sentence.
pub(super) const LABEL: usize = 9;

/// Returns the width of a column of names.
pub(super) fn width<'a>(names: impl Iterator<Item = &'a String>) -> usize {
    names.map(String::len).fold(28, usize::max)
}

/// Formats a value, or returns a dash if it is missing.
pub(super) fn cell<T>(value: Option<T>, words: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| "-".into(), words)
}

/// Returns the remark on a parameter at its bound.
pub(super) fn at_bound_words(at_bound: bool) -> &'static str {
    if at_bound { "  AT BOUND" } else { "" }
}

/// Breaks a sentence between words, with a label before the first line and the other lines indented; the unit `N m` stays whole.
pub(super) fn labelled(label: &str, sentence: &str) -> String {
    let mut text = format!("{label:<LABEL$}");
    let mut column = LABEL;
    let whole = sentence.replace("N m", "N\u{a0}m");
    for (i, word) in whole.split(' ').enumerate() {
        let width = word.chars().count();
        if i > 0 && column + 1 + width > WIDTH {
            let _ = write!(text, "\n{:LABEL$}", "");
            column = LABEL;
        } else if i > 0 {
            text.push(' ');
            column += 1;
        }
        text.push_str(&word.replace('\u{a0}', " "));
        column += width;
    }
    text + "\n"
}
