//! The place of a mistake in a file.

/// Returns line and column of a byte, each counted from 1; columns count characters.
pub(super) fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let start_of_line = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.bytes().filter(|&b| b == b'\n').count() + 1;
    (line, before[start_of_line..].chars().count() + 1)
}

/// Returns the byte, in a quoted TOML string as it stands in the file, at which a character of its content begins.
pub(super) fn in_string(raw: &str, content: &str, character: usize) -> usize {
    let lines = raw.starts_with("\"\"\"") || raw.starts_with("'''");
    let escapes = raw.starts_with('"');
    let rest = |at: usize| raw.get(at..).unwrap_or_default();
    let mut at = if lines { 3 } else { 1 };
    if lines {
        // a newline right after the quotes does not belong to the content
        at += rest(at).len() - rest(at).trim_start_matches('\r').len();
        at += usize::from(rest(at).starts_with('\n'));
    }
    let past_joint = |at: usize| match rest(at).strip_prefix('\\') {
        // a backslash at the end of a line joins it with the next word
        Some(after) if escapes && after.starts_with(char::is_whitespace) => {
            raw.len() - after.trim_start().len()
        }
        _ => at,
    };
    at = past_joint(at);
    for written in content.chars().take(character) {
        let remainder = rest(at);
        at += match remainder.as_bytes() {
            [b'\\', b'u', ..] if escapes => 6,
            [b'\\', b'U', ..] if escapes => 10,
            [b'\\', b'x', ..] if escapes => 4,
            [b'\\', ..] if escapes => 2,
            [b'\r', b'\n', ..] if written == '\n' => 2,
            _ => remainder.chars().next().map_or(0, char::len_utf8),
        };
        at = past_joint(at);
    }
    at.min(raw.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_characters_from_one() {
        let text = "α\r\nβγ\n";
        for (byte, expected) in [
            (0, (1, 1)),
            (2, (1, 2)),
            (4, (2, 1)),
            (6, (2, 2)),
            (9, (3, 1)),
            (99, (3, 1)),
        ] {
            assert_eq!(line_and_column(text, byte), expected, "{byte}");
        }
    }

    #[test]
    fn characters_are_found_in_every_kind_of_string() {
        for raw in [
            "\"p * ! 1\"",
            "'p * ! 1'",
            "\"\"\"p * ! 1\"\"\"",
            "'''\np *\n ! 1'''",
            "\"\"\"\r\np *\r\n ! 1\"\"\"",
            "\"\"\"p \\\n   * \\\r\n  ! 1\"\"\"",
            "\"\\u0070 \\x2a \\U00000021 1\"",
            "\"p\\t\\t* ! 1\"",
            "\"é * ! 1\"",
        ] {
            let table: toml::Table = toml::from_str(&format!("a = {raw}")).unwrap();
            let content = table["a"].as_str().unwrap();
            let character = content.chars().position(|c| c == '!').unwrap();
            let remainder = &raw[in_string(raw, content, character)..];
            assert!(
                remainder.starts_with('!') || remainder.starts_with("\\U"),
                "{raw:?}: {remainder:?}"
            );
        }
    }

    #[test]
    fn the_end_of_a_string_lies_before_its_closing_quotes() {
        for (raw, content) in [("\"\"", ""), ("'p '", "p "), ("\"\"\"\np\n\"\"\"", "p\n")] {
            let at = in_string(raw, content, content.chars().count());
            assert!(raw[at..].starts_with(['"', '\'']), "{raw}");
            assert!(raw[at..].len() <= 3, "{raw}");
        }
    }
}
