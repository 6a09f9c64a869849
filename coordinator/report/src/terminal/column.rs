//! Widths and cells of columns, and sentences broken into lines.

use std::fmt::Write;

/// Columns of a line.
const WIDTH: usize = 80;
/// Columns of a label before a sentence.
pub(super) const LABEL: usize = 9;

/// The width of a column of names.
pub(super) fn width<'a>(names: impl Iterator<Item = &'a String>) -> usize {
    names.map(String::len).fold(28, usize::max)
}

/// A value that may be missing.
pub(super) fn cell<T>(value: Option<T>, words: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| "-".into(), words)
}

/// The remark on a parameter at its bound.
pub(super) fn at_bound_words(at_bound: bool) -> &'static str {
    if at_bound { "  AT BOUND" } else { "" }
}

/// A sentence behind its label, broken between words and indented; a compound unit stays whole.
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
