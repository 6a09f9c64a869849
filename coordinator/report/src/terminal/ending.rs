//! The last lines of a command: where the files are, and how to open the study in a browser.

use std::path::Path;

use super::column::LABEL;

/// Characters that need no quotes in a shell, in addition to letters and digits.
const PLAIN: &str = "/._-+=:,@%";

/// Names the files in a folder, and the command that shows the study in a browser.
pub fn ending(folder: &Path) -> String {
    let out = folder.display();
    let store = quoted(&format!("sqlite://{}", folder.join("grouser.db").display()));
    // A path and a command stay on one line, so that they can be copied.
    format!(
        "{:LABEL$}report.html and its data in {out}\n{:LABEL$}coordinator serve --read-only --store {store}\n",
        "files:", "page:"
    )
}

/// Quotes a word for a Unix shell.
pub(super) fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || PLAIN.contains(c);
    match word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_of_the_page_is_one_line_and_names_the_store() {
        let text = ending(Path::new("out/sand"));
        let last = text.lines().last();
        let command = "page:    coordinator serve --read-only --store sqlite://out/sand/grouser.db";
        assert_eq!(last, Some(command));
        assert!(text.starts_with("files:   report.html and its data in out/sand\n"));
    }

    #[test]
    fn a_word_that_a_shell_would_split_is_quoted() {
        assert_eq!(quoted("out/Sand-1"), "out/Sand-1");
        assert_eq!(quoted("my rig/it's"), "'my rig/it'\\''s'");
    }
}
