//! Messages: an error and its causes in one sentence, and a stranger's text in one line.

use std::borrow::Cow;

/// Longest message that is shown whole `[bytes]`; of a longer one the middle is left out.
const LONGEST: usize = 1500;
/// What is shown of the end of such a message, where bounds stand `[bytes]`.
const END: usize = 300;

/// A text as one line of bounded length. Control characters become escapes, so that it moves no cursor and sets no colour; the middle of
/// a long text is left out.
pub fn one_line(text: &str) -> Cow<'_, str> {
    let mut line = Cow::Borrowed(text);
    if text.contains(char::is_control) {
        let escaped = |c: char| match c.is_control() {
            true => c.escape_default().to_string(),
            false => c.to_string(),
        };
        line = text.chars().map(escaped).collect::<String>().into();
    }
    if line.len() > LONGEST {
        let start = line.floor_char_boundary(LONGEST - END);
        let end = line.ceil_char_boundary(line.len() - END);
        line = format!("{} … {}", &line[..start], &line[end..]).into();
    }
    line
}

/// Joins an error and its causes, from the outermost in; a cause that the text already contains is not repeated.
pub fn of_causes(causes: impl Iterator<Item = impl ToString>) -> String {
    causes
        .map(|cause| cause.to_string())
        .reduce(|text, cause| {
            if text.contains(&cause) {
                text
            } else {
                format!("{text}: {cause}")
            }
        })
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::{LONGEST, of_causes, one_line};

    #[test]
    fn a_line_moves_no_cursor_and_has_an_end() {
        assert_eq!(one_line("5 µm, \"mesh\""), "5 µm, \"mesh\"");
        assert_eq!(one_line("a\nb\u{1b}[31m\0"), "a\\nb\\u{1b}[31m\\u{0}");
        let long = format!("x \"{}\" must be at most 3", "é\u{7}".repeat(100_000));
        let line = one_line(&long);
        assert!(
            line.len() <= LONGEST + 10 && line.starts_with("x \"é") && line.ends_with("must be at most 3"),
            "{line}"
        );
    }

    #[test]
    fn every_cause_is_said_once() {
        let causes = ["store: file is locked", "file is locked", "code 5"];
        assert_eq!(of_causes(causes.into_iter()), "store: file is locked: code 5");
        assert_eq!(of_causes(std::iter::empty::<&str>()), "");
    }
}
