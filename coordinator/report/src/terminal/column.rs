//! Helpers for columns of text: widths, cells that may be empty, sentences broken into lines.

use std::fmt::Write;

/// Number of characters in a line of a text whose reader's terminal is not known.
pub const WIDTH: usize = 80;
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

/// Breaks a sentence into lines of [`WIDTH`] characters, as [`labelled_to`] does.
pub(super) fn labelled(label: &str, sentence: &str) -> String {
    labelled_to(WIDTH, label, sentence)
}

/// Breaks a sentence between words, with a label before the first line and the other lines indented; the unit `N m` stays whole.
pub fn labelled_to(line_width: usize, label: &str, sentence: &str) -> String {
    let mut text = format!("{label:<LABEL$}");
    let mut column = LABEL;
    let whole = sentence.replace("N m", "N\u{a0}m");
    for (i, word) in whole.split(' ').enumerate() {
        let width = word.chars().count();
        if i > 0 && column + 1 + width > line_width {
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

/// Breaks a sentence into at most `lines` lines, one or more. Of a longer one, the last clauses are left out, or the last words where that
/// would leave lines unused, and `...` stands in their place.
pub(super) fn labelled_within(line_width: usize, lines: usize, label: &str, sentence: &str) -> String {
    let whole = labelled_to(line_width, label, sentence);
    if whole.lines().count() <= lines {
        return whole;
    }
    let ends = |mark: &str| sentence.match_indices(mark).map(|(at, _)| at).collect::<Vec<_>>();
    let longest = |mark: &str| {
        let texts = ends(mark).into_iter().rev();
        let mut texts = texts.map(|at| labelled_to(line_width, label, &format!("{} ...", &sentence[..at])));
        texts.find(|text| text.lines().count() <= lines)
    };
    let clauses = ["; ", ", "].iter().filter_map(|mark| longest(mark));
    let mut whole_clauses = clauses.filter(|text| text.lines().count() == lines);
    whole_clauses.next().or_else(|| longest(" ")).unwrap_or(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_loses_its_last_clauses_before_its_words() {
        let sentence = "one two three; four five six; seven eight nine";
        assert_eq!(
            labelled_within(30, 1, "a:", sentence),
            "a:       one two three ...\n"
        );
        assert_eq!(
            labelled_within(32, 2, "a:", sentence),
            "a:       one two three; four\n         five six ...\n"
        );
        let words = "one two three four five six";
        assert_eq!(labelled_within(24, 1, "a:", words), "a:       one two ...\n");
        assert_eq!(labelled_within(80, 1, "a:", words), labelled("a:", words));
    }
}
