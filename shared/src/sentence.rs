//! Sentences for messages: an error and its causes in one sentence, and untrusted text in one line.

use std::borrow::Cow;

/// The maximum length of a message shown whole `[bytes]`; a longer one loses its middle.
const LONGEST: usize = 1500;
/// Length of the end that is kept, because bounds stand there `[bytes]`.
const END: usize = 300;

/// Returns a text as one line of bounded length. Control characters become escapes, so that it cannot move the cursor or set
/// a colour; a long text loses its middle.
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

/// Joins an error and its causes, outermost first; a cause that the text already contains is not repeated.
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
        assert!(line.len() <= LONGEST + 10, "{line}");
        assert!(
            line.starts_with("x \"é") && line.ends_with("must be at most 3"),
            "{line}"
        );
    }

    #[test]
    fn every_cause_is_stated_once() {
        let causes = ["store: file is locked", "file is locked", "code 5"];
        assert_eq!(of_causes(causes.into_iter()), "store: file is locked: code 5");
        assert_eq!(of_causes(std::iter::empty::<&str>()), "");
    }
}
